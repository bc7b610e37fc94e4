// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/message_rows.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "messages/joint_affixes.hpp"
#include "messages/tracker_messages.hpp"
#include "recordings/recording_options.hpp"
#include "tracking/telemetry_rows.hpp"

namespace hjt
{
namespace
{
constexpr double CLOCK_STEP = 1.0;  // largest difference of neighbouring messages in delay from stamp to recording [s]

/// Whether the efforts of all `names` are exactly zero. For a single name, its position and velocity must be zero too.
bool isWithoutEffort(const sensor_msgs::JointState& message, const std::vector<std::string>& names)
{
  const auto is_zero = [&](const std::vector<double>& values, const std::string& name)
  {
    const std::size_t place = placeOf(message, name);
    return place >= values.size() || values[place] == 0.0;
  };
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name)
                     {
                       return is_zero(message.effort, name) && (names.size() > 1 || (is_zero(message.position, name) &&
                                                                                     is_zero(message.velocity, name)));
                     });
}

bool isVoid(const MotionRow& row)
{
  return row.position == 0.0 && row.current == 0.0 && !(std::abs(row.recorded_velocity) > 0.0);
}

/// Whether the values of a joint, or the angles of all joints, jump to exactly zero, as from a source without values.
/// Without a jump, a joint has come to rest at an angle of zero, perhaps without a load, like a wrist of a twin.
bool isVoidAfter(const std::vector<MotionRow>& before, const std::vector<MotionRow>& rows)
{
  constexpr std::size_t MANY = 3;
  constexpr double JUMP = 0.002;  // least jump [rad]: a joint that brakes at 16 rad/s^2 moves so far in its last 16 ms
  const auto is_at_zero = [](const MotionRow& row) { return row.position == 0.0; };
  const auto all_at_zero = [&](const std::vector<MotionRow>& all)
  { return all.size() >= MANY && std::all_of(all.begin(), all.end(), is_at_zero); };
  bool is_void = all_at_zero(rows) && !all_at_zero(before);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    is_void = is_void || (isVoid(rows[i]) && std::abs(before[i].position) > JUMP && before[i].current != 0.0);
  }
  return is_void;
}

/// Joints without an effort, if the message has fewer efforts than names. Motors are not counted as joints.
std::vector<std::string> beyondEfforts(const sensor_msgs::JointState& message)
{
  return message.effort.size() < message.name.size() ?
             withoutMotors(
                 { message.name.begin() + static_cast<std::ptrdiff_t>(message.effort.size()), message.name.end() }) :
             std::vector<std::string>();
}

/// Joints with at least one numeric angle, and joints with at least one numeric effort.
struct JointsSeen
{
  void add(const sensor_msgs::JointState& message, const std::vector<std::string>& names)
  {
    for (const std::string& name : names)
    {
      const std::size_t place = placeOf(message, name);
      const bool has_effort = place < message.effort.size();
      if (has_effort && place < message.position.size() && std::isfinite(message.position[place]))
      {
        angles.insert(name);
      }
      if (has_effort && std::isfinite(message.effort[place]))
      {
        efforts.insert(name);
      }
    }
  }

  std::set<std::string> silent() const
  {
    std::set<std::string> silent;
    if (!efforts.empty())
    {
      std::set_difference(angles.begin(), angles.end(), efforts.begin(), efforts.end(),
                          std::inserter(silent, silent.begin()));
    }
    return silent;
  }

  std::set<std::string> angles;
  std::set<std::string> efforts;
};
}  // namespace

TopicLayout readLayout(RecordedMessages& recording, const MotionSource& source, const std::vector<std::string>& names)
{
  TopicLayout layout;
  bool is_whole = false;
  JointsSeen seen;
  std::set<std::vector<std::size_t>> parts;
  recording.visit(
      { source.topic }, false,
      [&](const RecordedMessage& message)
      {
        if (message.state == nullptr)
        {
          return true;
        }
        std::vector<std::size_t> part;
        for (std::size_t i = 0; i < names.size(); ++i)
        {
          if (placeOf(*message.state, names[i]) < message.state->name.size())
          {
            part.push_back(i);
          }
        }
        if (part.empty())
        {
          return true;
        }
        layout.has_stamps = layout.has_stamps || !message.state->header.stamp.isZero();
        layout.has_efforts = layout.has_efforts || !isWithoutEffort(*message.state, names);
        is_whole = is_whole || part.size() == names.size();
        parts.insert(part);
        seen.add(*message.state, names);
        return !(is_whole && layout.has_stamps && layout.has_efforts && seen.efforts.size() == names.size());
      },
      [](double) {});
  layout.silent = seen.silent();
  // A joint that is in several parts belongs to the largest of these parts.
  std::vector<std::vector<std::size_t>> sorted(parts.begin(), parts.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::set<std::size_t> taken;
  for (const std::vector<std::size_t>& part : sorted)
  {
    if (std::none_of(part.begin(), part.end(), [&](std::size_t joint) { return taken.count(joint) > 0; }))
    {
      layout.parts.push_back(part);
      taken.insert(part.begin(), part.end());
    }
  }
  return layout;
}

MessageRows::MessageRows(const MotionSource& source, const std::vector<std::string>& names, const TopicLayout& layout,
                         Visit visit)
  : source_(source)
  , layout_(layout)
  , visit_(std::move(visit))
  , joints_(names)
  , names_(names.begin(), names.end())
  , angles_(names.size())
  , loads_(names.size())
  , temperatures_(names.size())
{
}

bool MessageRows::read(const RecordedMessage& message)
{
  if (message.temperature != nullptr)
  {
    for (std::size_t i = 0; i < names_.size(); ++i)
    {
      if (message.temperature->header.frame_id == names_[i].joint)
      {
        temperatures_[i].push(toSeconds(message.stamp()), message.temperature->temperature);
      }
    }
    return true;
  }
  if (message.topic == source_.topic)
  {
    if (message.state == nullptr)
    {
      ++corrupt_;
      return true;
    }
    return takeTelemetry(*message.state, message);
  }
  if (message.state != nullptr)
  {
    readLoad(*message.state, message.stamp());
  }
  return true;
}

bool MessageRows::flush()
{
  if (!waiting_)
  {
    return true;
  }
  StampedRows held = std::move(*waiting_);
  waiting_.reset();
  if (!held.agrees && seen_ > 1)
  {
    ++corrupt_;
    return true;
  }
  for (std::size_t i = 0; i < names_.size(); ++i)
  {
    held.rows[i].temperature = temperatures_[i].at(toSeconds(held.stamp));
  }
  return visit_(held);
}

bool MessageRows::agree(const StampedRows& a, const StampedRows& b) const
{
  const double time = std::abs(toSeconds(b.recorded - a.recorded)) + RowFilter::SLACK;
  bool agrees = std::abs(b.delay() - a.delay()) < CLOCK_STEP;
  for (std::size_t i = 0; i < names_.size(); ++i)
  {
    agrees = agrees && std::abs(b.rows[i].position - a.rows[i].position) < MotionSource::FASTEST * time;
  }
  return agrees;
}

/// Whether the message shows which joint an effort belongs to. For a single joint, a message with fewer efforts than
/// names does so only if the names without an effort belong to another arm.
bool MessageRows::tellsWhose(const sensor_msgs::JointState& message) const
{
  const std::vector<std::string> beyond = beyondEfforts(message);
  const auto is_sibling = [&](const std::string& name)
  { return !findUrJoint(joints_.front()) || findUrJoint(name).has_value(); };
  return beyond.empty() || message.effort.empty() || joints_.size() > 1 ||
         std::none_of(beyond.begin(), beyond.end(), is_sibling);
}

/// Makes rows from a message. Returns false if a value of a joint is missing or impossible.
bool MessageRows::readRows(const sensor_msgs::JointState& message, std::vector<MotionRow>& rows)
{
  if (!tellsWhose(message))
  {
    has_short_efforts_ = true;
    return false;
  }
  for (std::size_t i = 0; i < names_.size(); ++i)
  {
    TelemetryStatus status = readTelemetry(message, names_[i], rows[i]);
    if (status == TelemetryStatus::WITHOUT_EFFORT && layout_.silent.count(joints_[i]) > 0)
    {
      rows[i].current = 0.0;
      status = TelemetryStatus::FOUND;
    }
    rows[i].current *= source_.current_per_effort;
    const std::size_t motor = placeOf(message, names_[i].motor);
    if (source_.current_per_motor_torque > 0.0 && motor < message.effort.size())
    {
      rows[i].current = source_.current_per_motor_torque * message.effort[motor];
    }
    if (status == TelemetryStatus::WITHOUT_EFFORT || status == TelemetryStatus::NOT_FINITE)
    {
      ++missing_[joints_[i]];
    }
    if (status != TelemetryStatus::FOUND || !isPlausibleEffort(rows[i].current))
    {
      return false;
    }
    rows[i].load = loads_[i];
  }
  return true;
}

bool MessageRows::takeTelemetry(const sensor_msgs::JointState& message, const RecordedMessage& recorded)
{
  const auto is_named = [&](const JointNames& names) { return placeOf(message, names.joint) < message.name.size(); };
  if (std::none_of(names_.begin(), names_.end(), is_named))
  {
    return true;
  }
  StampedRows held;
  held.rows.resize(names_.size());
  if (!readRows(message, held.rows))
  {
    ++corrupt_;
    return true;
  }
  if (layout_.has_stamps && message.header.stamp.isZero())
  {
    ++without_time_;
    return true;
  }
  if ((layout_.has_efforts && isWithoutEffort(message, joints_)) || (last_ && isVoidAfter(last_->rows, held.rows)))
  {
    ++without_effort_;
    return true;
  }
  held.stamp = recorded.stamp();
  held.recorded = recorded.recorded;
  held.publisher = recorded.publisher;
  for (std::size_t i = 0; i < names_.size(); ++i)
  {
    held.rows[i].position = angles_[i].take(toSeconds(held.stamp), held.rows[i].position);
  }
  sources_.add(held.publisher, held.rows);
  held.agrees = last_ && agree(*last_, held);
  if (waiting_ && held.agrees)
  {
    waiting_->agrees = true;
  }
  last_ = held;
  ++seen_;
  const bool more = flush();
  waiting_ = std::move(held);
  return more;
}

void MessageRows::readLoad(const sensor_msgs::JointState& message, Stamp stamp)
{
  for (std::size_t i = 0; i < names_.size(); ++i)
  {
    const std::size_t place = placeOf(message, names_[i].joint);
    if (place >= message.effort.size() || !isPlausibleEffort(message.effort[place]))
    {
      continue;
    }
    loads_[i] = message.effort[place];
    if (waiting_ && stamp <= waiting_->stamp)
    {
      waiting_->rows[i].load = loads_[i];
    }
  }
}

std::uint64_t MessageRows::refusedTemperatures() const
{
  std::uint64_t refused = 0;
  for (const TemperatureRecord& temperatures : temperatures_)
  {
    refused += temperatures.refused();
  }
  return refused;
}
}  // namespace hjt
