// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recorded_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <optional>
#include <set>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bags/bag_file.hpp"
#include "bags/checked_message.hpp"
#include "base/joined.hpp"
#include "base/number_table.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/telemetry_messages.hpp"
#include "messages/time.hpp"
#include "tracking/held_values.hpp"
#include "tracking/plausible.hpp"
#include "tracking/time_fit.hpp"

namespace hjt
{
namespace
{
constexpr double FASTEST = 20.0;    // joint; faster ones are damaged angles [rad/s]
constexpr double SLACK = 0.02;      // of the time a joint has for its way: messages come in bursts [s]
constexpr double CLOCK_STEP = 1.0;  // by which the delay of a message may differ from its neighbour's [s]

/// Turns messages into rows. A row waits for the next one: a load with its own stamp can still reach it, and the next
/// one tells whether it can be true.
class BagRows
{
public:
  BagRows(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit)
    : source_(source), visit_(visit), names_(source.joint)
  {
  }

  /// False: the visitor has had enough.
  bool read(const rosbag::MessageInstance& instance)
  {
    if (instance.isType<sensor_msgs::Temperature>())
    {
      readTemperature(instance);
      return true;
    }
    if (!message_.read(instance))
    {
      ++count_.corrupt;
      return true;
    }
    const sensor_msgs::JointState& state = message_.state();
    const Stamp stamp = stampOr(state.header.stamp, instance.getTime());
    if (instance.getTopic() == source_.topic)
    {
      return takeTelemetry(state, stamp, fromRosTime(instance.getTime()));
    }
    readLoad(state, stamp);
    return true;
  }

  /// Hands on the row that waits, if it can be true.
  bool flush()
  {
    if (!waiting_)
    {
      return true;
    }
    const Held held = *waiting_;
    waiting_.reset();
    if (!held.agrees && seen_ > 1)
    {
      ++count_.corrupt;
      return true;
    }
    if (!start_)
    {
      start_ = held.stamp;
      count_.start = held.stamp;
      count_.least_delay = count_.most_delay = held.delay();
    }
    MotionRow row = held.row;
    row.time = toSeconds(held.stamp - *start_);
    row.received = toSeconds(held.recorded - *start_);
    row.temperature = temperatures_.at(toSeconds(held.stamp));
    count_.duration = std::max(count_.duration, row.time);
    count_.least_delay = std::min(count_.least_delay, held.delay());
    count_.most_delay = std::max(count_.most_delay, held.delay());
    ++count_.rows;
    return visit_(row);
  }

  MotionCount count() const
  {
    MotionCount count = count_;
    count.refused_temperatures = temperatures_.refused();
    return count;
  }
  const std::set<std::string>& others() const { return others_; }

private:
  struct Held
  {
    MotionRow row;
    Stamp stamp{};
    Stamp recorded{};
    bool agrees{};  // with a neighbour

    double delay() const { return toSeconds(recorded - stamp); }
  };

  static bool agree(const Held& a, const Held& b)
  {
    const double time = std::abs(toSeconds(b.recorded - a.recorded)) + SLACK;
    return std::abs(b.delay() - a.delay()) < CLOCK_STEP && std::abs(b.row.position - a.row.position) < FASTEST * time;
  }

  bool takeTelemetry(const sensor_msgs::JointState& message, Stamp stamp, Stamp recorded)
  {
    Held held;
    const TelemetryStatus status = readTelemetry(message, names_, held.row);
    if (status == TelemetryStatus::UNKNOWN_JOINT)
    {
      others_.insert(message.name.begin(), message.name.end());
      return true;
    }
    held.row.current *= source_.current_per_effort;
    const std::size_t motor = placeOf(message, names_.motor);
    if (source_.current_per_motor_torque > 0.0 && motor < message.effort.size())
    {
      held.row.current = source_.current_per_motor_torque * message.effort[motor];
    }
    if (status != TelemetryStatus::FOUND || !isPlausibleEffort(held.row.current))
    {
      ++count_.corrupt;
      return true;
    }
    held.row.load = load_;
    held.stamp = stamp;
    held.recorded = recorded;
    held.agrees = last_ && agree(*last_, held);
    if (waiting_ && held.agrees)
    {
      waiting_->agrees = true;
    }
    last_ = held;
    ++seen_;
    const bool more = flush();
    waiting_ = held;
    return more;
  }

  void readLoad(const sensor_msgs::JointState& message, Stamp stamp)
  {
    const std::size_t i = placeOf(message, names_.joint);
    if (i < message.effort.size() && isPlausibleEffort(message.effort[i]))
    {
      load_ = message.effort[i];
      if (waiting_ && stamp <= waiting_->stamp)
      {
        waiting_->row.load = load_;
      }
    }
  }

  void readTemperature(const rosbag::MessageInstance& instance)
  {
    if (message_.readTemperature(instance) && message_.temperature().header.frame_id == names_.joint)
    {
      const Stamp stamp = stampOr(message_.temperature().header.stamp, instance.getTime());
      temperatures_.push(toSeconds(stamp), message_.temperature().temperature);
    }
  }

  const MotionSource& source_;
  const std::function<bool(const MotionRow&)>& visit_;
  CheckedMessage message_;
  MotionCount count_;
  JointNames names_;
  std::set<std::string> others_;  // joints in messages that do not name this one
  std::optional<Held> waiting_;
  std::optional<Held> last_;  // as it came, true or not
  std::uint64_t seen_{};      // the only row has no neighbour to disagree with
  std::optional<Stamp> start_;
  double load_{};
  TemperatureRecord temperatures_;
};

/// The messages that rows are made of.
class MotionView : public rosbag::View
{
public:
  MotionView(const rosbag::Bag& bag, const MotionSource& source)
  {
    addQuery(bag, rosbag::TopicQuery(std::vector<std::string>{ source.topic, source.load_topic }));
    addQuery(bag, rosbag::TypeQuery(ros::message_traits::datatype<sensor_msgs::Temperature>()));
  }
};

MotionCount readBag(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                    const std::function<void(double)>& progress)
{
  rosbag::Bag bag;
  openForReading(bag, source.path);
  rosbag::View telemetry(bag, rosbag::TopicQuery(source.topic));
  if (telemetry.size() == 0)
  {
    throw InputError(source.path + " has no messages on " + source.topic + "; it holds:" + listTopics(bag));
  }
  MotionView view(bag, source);
  BagRows rows(source, visit);
  const double total = view.size();
  double done = 0.0;
  bool more = true;
  for (auto instance = view.begin(); more && instance != view.end(); ++instance)
  {
    more = rows.read(*instance);
    progress(++done / total);
  }
  rows.flush();
  if (rows.count().rows == 0)
  {
    const std::string found = joined(rows.others());
    throw InputError(source.topic + " never contains angle and effort of joint '" + source.joint +
                     "'; joints found: " + (found.empty() ? "none" : found));
  }
  return rows.count();
}

/// Rows of the joints of an arm, put side by side by their times.
class SideBySide
{
public:
  SideBySide(std::size_t joints, const std::function<bool(const std::vector<MotionRow>&)>& visit)
    : waiting_(joints), rows_(joints), visit_(visit)
  {
  }

  /// False: the visitor has had enough.
  bool add(std::size_t joint, const MotionRow& row)
  {
    waiting_[joint].push_back(row);
    while (const std::optional<double> time = nextTime())
    {
      bool is_complete = true;
      for (std::size_t i = 0; i < waiting_.size(); ++i)
      {
        rows_[i] = waiting_[i].front();
        is_complete = is_complete && rows_[i].time > *time - SAME_TIME;
      }
      for (std::deque<MotionRow>& rows : waiting_)
      {
        if (is_complete || rows.front().time < *time - SAME_TIME)
        {
          rows.pop_front();
        }
      }
      dropped_ += is_complete ? 0 : 1;
      complete_ += is_complete ? 1 : 0;
      if (is_complete && !visit_(rows_))
      {
        return false;
      }
    }
    return true;
  }

  std::uint64_t complete() const { return complete_; }
  std::uint64_t dropped() const { return dropped_; }

private:
  static constexpr double SAME_TIME = 1e-6;  // [s]

  /// The latest of the first rows that wait; none: a joint has no row.
  std::optional<double> nextTime() const
  {
    double latest = -HUGE_VAL;
    for (const std::deque<MotionRow>& rows : waiting_)
    {
      if (rows.empty())
      {
        return std::nullopt;
      }
      latest = std::max(latest, rows.front().time);
    }
    return latest;
  }

  std::vector<std::deque<MotionRow>> waiting_;
  std::vector<MotionRow> rows_;
  const std::function<bool(const std::vector<MotionRow>&)>& visit_;
  std::uint64_t complete_{};
  std::uint64_t dropped_{};
};

MotionCount readArmBag(const MotionSource& source, const std::vector<std::string>& names,
                       const std::function<bool(const std::vector<MotionRow>&)>& visit,
                       const std::function<void(double)>& progress)
{
  rosbag::Bag bag;
  openForReading(bag, source.path);
  if (rosbag::View(bag, rosbag::TopicQuery(source.topic)).size() == 0)
  {
    throw InputError(source.path + " has no messages on " + source.topic + "; it holds:" + listTopics(bag));
  }
  MotionView view(bag, source);

  struct Joint
  {
    MotionSource source;
    std::function<bool(const MotionRow&)> visit;
    std::optional<BagRows> rows;
  };
  SideBySide side_by_side(names.size(), visit);
  std::optional<Stamp> start;  // of the first joint that has a row; times count from there
  std::vector<Joint> joints(names.size());
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    joints[i].source = source;
    joints[i].source.joint = names[i];
    joints[i].visit = [&, i](const MotionRow& row)
    {
      const Stamp own_start = joints[i].rows->count().start;
      start = start.value_or(own_start);
      MotionRow shifted = row;
      shifted.time += toSeconds(own_start - *start);
      shifted.received += toSeconds(own_start - *start);
      return side_by_side.add(i, shifted);
    };
    joints[i].rows.emplace(joints[i].source, joints[i].visit);
  }
  const double total = view.size();
  double done = 0.0;
  bool more = true;
  for (auto instance = view.begin(); more && instance != view.end(); ++instance)
  {
    for (Joint& joint : joints)
    {
      more = more && joint.rows->read(*instance);
    }
    progress(++done / total);
  }
  for (Joint& joint : joints)
  {
    more = more && joint.rows->flush();
  }

  std::vector<std::string> missing;
  std::set<std::string> found;
  for (const Joint& joint : joints)
  {
    found.insert(joint.rows->others().begin(), joint.rows->others().end());
    if (joint.rows->count().rows == 0)
    {
      missing.push_back(joint.source.joint);
    }
  }
  if (!missing.empty())
  {
    throw InputError(source.topic + " never contains angle and effort of " + joined(missing) +
                     "; joints found: " + (found.empty() ? "none" : joined(found)));
  }
  if (side_by_side.complete() == 0)
  {
    throw InputError(source.topic + " never contains all joints of the arm in one message: " + joined(names));
  }
  MotionCount count = joints.front().rows->count();
  count.rows = side_by_side.complete();
  count.start = *start;
  count.corrupt += side_by_side.dropped();
  count.refused_temperatures = 0;
  for (const Joint& joint : joints)
  {
    count.refused_temperatures += joint.rows->count().refused_temperatures;
  }
  return count;
}

constexpr std::size_t CSV_JOINTS = 6;

MotionCount readArmCsv(const MotionSource& source, const std::vector<std::string>& names,
                       const std::function<bool(const std::vector<MotionRow>&)>& visit,
                       const std::function<void(double)>& progress)
{
  if (names.size() != CSV_JOINTS)
  {
    throw InputError(source.path + ": a controller's CSV recording has " + std::to_string(CSV_JOINTS) +
                     " joints, the arm has " + std::to_string(names.size()));
  }
  constexpr std::array<const char*, 5> QUANTITIES{ "actual_q_", "actual_current_", "target_moment_", "actual_qd_",
                                                   "joint_temperatures_" };
  constexpr std::size_t COLUMNS = 1 + QUANTITIES.size() * CSV_JOINTS;
  const auto column = [](std::size_t quantity, std::size_t joint) { return 1 + quantity * CSV_JOINTS + joint; };
  NumberTable<COLUMNS>::Names columns{ "timestamp" };
  for (std::size_t i = 0; i < CSV_JOINTS; ++i)
  {
    for (std::size_t quantity = 0; quantity < QUANTITIES.size(); ++quantity)
    {
      columns[column(quantity, i)] = QUANTITIES[quantity] + std::to_string(i);
    }
  }
  NumberTable<COLUMNS> table(source.path, columns, COLUMNS - 1, CSV_JOINTS);
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < CSV_JOINTS; ++i)
  {
    if (!table.hasColumn(column(0, i)) || !table.hasColumn(column(1, i)))
    {
      missing.push_back(names[i] + " (" + columns[column(0, i)] + ", " + columns[column(1, i)] + ")");
    }
  }
  if (!missing.empty())
  {
    throw InputError(source.path + ":1: without angle and current of " + joined(missing));
  }

  MotionCount count;
  double first = 0.0;
  std::array<TemperatureRecord, CSV_JOINTS> temperatures;
  std::array<double, COLUMNS> values{};
  std::fill(values.begin() + column(3, 0), values.end(), std::nan(""));
  std::vector<MotionRow> rows(CSV_JOINTS);
  while (table.read(values))
  {
    if (count.rows++ == 0)
    {
      first = values[0];
      count.start = std::llround(1e9 * first);
    }
    const double time = values[0] - first;
    count.duration = std::max(count.duration, time);
    for (std::size_t i = 0; i < CSV_JOINTS; ++i)
    {
      rows[i] = { time, values[column(0, i)], values[column(1, i)], values[column(2, i)] };
      rows[i].received = time;
      rows[i].recorded_velocity = values[column(3, i)];
      if (table.hasColumn(column(4, i)))
      {
        temperatures[i].push(time, values[column(4, i)]);
        rows[i].temperature = temperatures[i].at(time);
      }
    }
    if (!visit(rows))
    {
      break;
    }
  }
  progress(1.0);
  if (count.rows == 0)
  {
    throw InputError(source.path + " has no rows");
  }
  for (const TemperatureRecord& joint : temperatures)
  {
    count.refused_temperatures += joint.refused();
  }
  return count;
}

using CsvTable = NumberTable<6>;

CsvTable openCsv(const MotionSource& source, std::size_t optional)
{
  const std::string n = "_" + std::to_string(source.csv_joint);
  return CsvTable(source.path,
                  { "timestamp", "actual_q" + n, "actual_current" + n, "target_moment" + n, "actual_qd" + n,
                    "joint_temperatures" + n },
                  optional, 1);
}

MotionCount readCsv(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                    const std::function<void(double)>& progress)
{
  CsvTable table = openCsv(source, 3);
  MotionCount count;
  double first = 0.0;
  TemperatureRecord temperatures;
  std::array<double, 6> row{};
  row[4] = std::nan("");
  while (table.read(row))
  {
    if (count.rows++ == 0)
    {
      first = row[0];
      count.start = std::llround(1e9 * first);
    }
    const double time = row[0] - first;
    count.duration = std::max(count.duration, time);
    MotionRow motion{ time, row[1], source.current_per_effort * row[2], row[3] };
    motion.received = time;
    motion.recorded_velocity = row[4];
    if (table.hasColumn(5))
    {
      temperatures.push(time, row[5]);
      motion.temperature = temperatures.at(time);
    }
    if (!visit(motion))
    {
      break;
    }
  }
  progress(1.0);
  count.refused_temperatures = temperatures.refused();
  if (count.rows == 0)
  {
    throw InputError(source.path + " has no rows");
  }
  return count;
}
void scaleTimes(double scale, MotionRow& row)
{
  row.time *= scale;
  row.received *= scale;
}
}  // namespace

bool isCsv(const MotionSource& source)
{
  const std::string end = ".csv";
  return source.path.size() >= end.size() && source.path.compare(source.path.size() - end.size(), end.size(), end) == 0;
}

bool recordsLoad(const MotionSource& source)
{
  if (isCsv(source))
  {
    return openCsv(source, 5).hasColumn(3);  // what else is missing is for the reader to say
  }
  rosbag::Bag bag;
  openForReading(bag, source.path);
  return rosbag::View(bag, rosbag::TopicQuery(source.load_topic)).size() > 0;
}

MotionCount readMotion(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                       const std::function<void(double)>& progress)
{
  TimeFit fit;
  const auto scaled = [&](const MotionRow& read)
  {
    MotionRow row = read;
    scaleTimes(source.time_scale, row);
    fit.add(row.time, row.position, row.recorded_velocity);
    return visit(row);
  };
  MotionCount count = isCsv(source) ? readCsv(source, scaled, progress) : readBag(source, scaled, progress);
  count.duration *= source.time_scale;
  count.velocity_ratio = fit.factor().value;
  return count;
}

MotionCount readArmMotion(const MotionSource& source, const std::vector<std::string>& names,
                          const std::function<bool(const std::vector<MotionRow>&)>& visit,
                          const std::function<void(double)>& progress)
{
  std::vector<MotionRow> rows;
  const auto scaled = [&](const std::vector<MotionRow>& read)
  {
    rows = read;
    for (MotionRow& row : rows)
    {
      scaleTimes(source.time_scale, row);
    }
    return visit(rows);
  };
  MotionCount count =
      isCsv(source) ? readArmCsv(source, names, scaled, progress) : readArmBag(source, names, scaled, progress);
  count.duration *= source.time_scale;
  return count;
}
}  // namespace hjt
