// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/recorded_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "base/number_table.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "ros_io/bag_file.hpp"
#include "ros_io/checked_message.hpp"
#include "ros_io/telemetry_messages.hpp"
#include "ros_io/time.hpp"
#include "tracking/plausible.hpp"

namespace hjt
{
namespace
{
constexpr double FASTEST = 20.0;    // joint; faster ones are damaged angles [rad/s]
constexpr double SLACK = 0.02;      // of the time a joint has for its way: messages come in bursts [s]
constexpr double CLOCK_STEP = 1.0;  // by which the delay of a message may differ from its neighbour's [s]

/// Holds the angles and stamps of neighbouring rows against the velocities that the recording gives beside them.
class VelocityCheck
{
public:
  /// `velocity`: recorded; NaN: none.
  void add(double time, double position, double velocity)
  {
    const double step = time - time_;
    const double mean = 0.5 * (velocity + velocity_);
    if (step > MotionDifferentiator::MIN_STEP && step < MotionDifferentiator::MAX_GAP && std::abs(mean) > SLOWEST)
    {
      products_ += (position - position_) / step * mean;
      squares_ += mean * mean;
      ++rows_;
    }
    time_ = time;
    position_ = position;
    velocity_ = velocity;
  }

  double ratio() const { return rows_ >= MIN_ROWS ? products_ / squares_ : 0.0; }

private:
  static constexpr double SLOWEST = 0.05;  // [rad/s]
  static constexpr int MIN_ROWS = 50;

  double time_{ -HUGE_VAL };
  double position_{};
  double velocity_{};
  double products_{};
  double squares_{};
  int rows_{};
};

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
      count_.start = toSeconds(held.stamp);
      count_.least_delay = count_.most_delay = held.delay();
    }
    MotionRow row = held.row;
    row.time = toSeconds(held.stamp - *start_);
    row.received = toSeconds(held.recorded - *start_);
    check_.add(row.time, row.position, held.velocity);
    count_.velocity_ratio = check_.ratio();
    count_.duration = std::max(count_.duration, row.time);
    count_.least_delay = std::min(count_.least_delay, held.delay());
    count_.most_delay = std::max(count_.most_delay, held.delay());
    ++count_.rows;
    return visit_(row);
  }

  MotionCount count() const { return count_; }
  const std::set<std::string>& others() const { return others_; }

private:
  struct Held
  {
    MotionRow row;
    double velocity{};  // as recorded; NaN: not at all [rad/s]
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
    const std::size_t joint = placeOf(message, names_.joint);
    held.velocity = joint < message.velocity.size() ? message.velocity[joint] : std::nan("");
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

  const MotionSource& source_;
  const std::function<bool(const MotionRow&)>& visit_;
  CheckedMessage message_;
  MotionCount count_;
  VelocityCheck check_;
  JointNames names_;
  std::set<std::string> others_;  // joints in messages that do not name this one
  std::optional<Held> waiting_;
  std::optional<Held> last_;  // as it came, true or not
  std::uint64_t seen_{};      // the only row has no neighbour to disagree with
  std::optional<Stamp> start_;
  double load_{};
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
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{ source.topic, source.load_topic }));
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
    std::string found;
    for (const std::string& name : rows.others())
    {
      found += (found.empty() ? "" : ", ") + name;
    }
    throw InputError(source.topic + " never contains angle and effort of joint '" + source.joint +
                     "'; joints found: " + (found.empty() ? "none" : found));
  }
  return rows.count();
}

using CsvTable = NumberTable<5>;

CsvTable openCsv(const MotionSource& source)
{
  const std::string n = "_" + std::to_string(source.csv_joint);
  return CsvTable(source.path,
                  { "timestamp", "actual_q" + n, "actual_current" + n, "target_moment" + n, "actual_qd" + n }, 2);
}

MotionCount readCsv(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                    const std::function<void(double)>& progress)
{
  CsvTable table = openCsv(source);
  MotionCount count;
  VelocityCheck check;
  std::array<double, 5> row{};
  row[4] = std::nan("");
  while (table.read(row))
  {
    if (count.rows++ == 0)
    {
      count.start = row[0];
    }
    const double time = row[0] - count.start;
    count.duration = std::max(count.duration, time);
    MotionRow motion{ time, row[1], row[2], row[3] };
    motion.received = time;
    check.add(time, row[1], row[4]);
    if (!visit(motion))
    {
      break;
    }
  }
  progress(1.0);
  count.velocity_ratio = check.ratio();
  if (count.rows == 0)
  {
    throw InputError(source.path + " has no rows");
  }
  return count;
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
    return openCsv(source).hasColumn(3);
  }
  rosbag::Bag bag;
  openForReading(bag, source.path);
  return rosbag::View(bag, rosbag::TopicQuery(source.load_topic)).size() > 0;
}

MotionCount readMotion(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                       const std::function<void(double)>& progress)
{
  return isCsv(source) ? readCsv(source, visit, progress) : readBag(source, visit, progress);
}
}  // namespace hjt
