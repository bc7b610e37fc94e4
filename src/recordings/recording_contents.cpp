// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_contents.hpp"

#include <algorithm>
#include <set>

#include "bags/recorded_messages.hpp"
#include "messages/conversions.hpp"

namespace hjt
{
namespace
{
constexpr const char* ANGLE_AND_CURRENT = "angle and current of the joint";
constexpr const char* MOTOR_ANGLE = "angle of the motor: torsion, stiffness, kinematic error";
constexpr const char* LOAD = "load at the output; else weight and inertia as configured";
constexpr const char* TEMPERATURE = "temperature of the drive; else as configured";
constexpr const char* TWIN = "angle and speed of a twin that ran beside the robot";

const auto NO_PROGRESS = [](double) {};
}  // namespace

RecordingContents readContents(const MotionSource& source, const std::string& twin_topic, const MotionCount& count,
                               std::uint64_t motor_rows, std::uint64_t temperature_rows, bool has_load)
{
  RecordingContents contents;
  if (isCsv(source))
  {
    const std::string n = "_" + std::to_string(source.csv_joint);
    contents.lines = { { "timestamp, actual_q" + n + ", actual_current" + n, ANGLE_AND_CURRENT, count.rows, true },
                       { "target_moment" + n, LOAD, has_load ? count.rows : 0, has_load },
                       { "joint_temperatures" + n, TEMPERATURE, temperature_rows, temperature_rows > 0 } };
    return contents;
  }
  const std::unique_ptr<RecordedMessages> recording = RecordedMessages::open(source.path);
  const std::uint64_t loads = recording->messagesOn(source.load_topic);
  const std::uint64_t twins = twin_topic == source.topic ? 0 : recording->messagesOn(twin_topic);
  contents.lines = { { source.topic, ANGLE_AND_CURRENT, count.rows, true },
                     { source.topic + ": " + JointNames(source.joint).motor, MOTOR_ANGLE, motor_rows, motor_rows > 0 },
                     { source.load_topic, LOAD, loads, loads > 0 },
                     { "sensor_msgs/Temperature of " + source.joint, TEMPERATURE, temperature_rows,
                       temperature_rows > 0 } };
  if (twin_topic != source.topic)
  {
    contents.lines.push_back({ twin_topic, TWIN, twins, twins > 0 });
  }
  recording->visit(
      { source.topic }, false,
      [&](const RecordedMessage& message)
      {
        contents.joints = message.state == nullptr ? contents.joints : message.state->name;
        return message.state == nullptr;
      },
      NO_PROGRESS);
  const std::set<std::string> used{ source.topic, source.load_topic, twin_topic };
  std::set<std::string> others;
  for (const auto& [name, topic] : recording->topics())
  {
    const bool is_temperature = temperature_rows > 0 && topic.type == TEMPERATURE_TYPE;
    if (!is_temperature && used.count(name) == 0)
    {
      others.insert(name);
    }
  }
  contents.other_topics.assign(others.begin(), others.end());
  return contents;
}

Decimated<TwinState> readTwinStates(const MotionSource& source, const std::string& twin_topic, double start)
{
  Decimated<TwinState> states;
  if (isCsv(source) || twin_topic == source.topic)
  {
    return states;
  }
  const std::unique_ptr<RecordedMessages> recording = RecordedMessages::open(source.path);
  if (recording->messagesOn(twin_topic) == 0)
  {
    return states;
  }
  const JointNames names(source.joint);
  recording->visit(
      { twin_topic }, false,
      [&](const RecordedMessage& message)
      {
        if (message.state == nullptr)
        {
          return true;
        }
        const sensor_msgs::JointState& state = *message.state;
        const std::size_t joint = placeOf(state, names.joint);
        const std::size_t motor = placeOf(state, names.motor);
        if (joint < std::min(state.position.size(), state.velocity.size()) && motor < state.effort.size())
        {
          states.add({ state.header.stamp.toSec() - start, state.position[joint], state.velocity[joint],
                       state.effort[motor] * source.current_per_motor_torque });
        }
        return true;
      },
      NO_PROGRESS);
  return states;
}
}  // namespace hjt
