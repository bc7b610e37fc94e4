// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_contents.hpp"

#include <algorithm>
#include <set>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bags/bag_file.hpp"
#include "bags/checked_message.hpp"
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

std::uint64_t messagesOn(const rosbag::Bag& bag, const std::string& topic)
{
  return rosbag::View(const_cast<rosbag::Bag&>(bag), rosbag::TopicQuery(topic)).size();
}
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
  rosbag::Bag bag;
  openForReading(bag, source.path);
  const std::uint64_t loads = messagesOn(bag, source.load_topic);
  const std::uint64_t twins = twin_topic == source.topic ? 0 : messagesOn(bag, twin_topic);
  contents.lines = { { source.topic, ANGLE_AND_CURRENT, count.rows, true },
                     { source.topic + ": " + JointNames(source.joint).motor, MOTOR_ANGLE, motor_rows, motor_rows > 0 },
                     { source.load_topic, LOAD, loads, loads > 0 },
                     { "sensor_msgs/Temperature of " + source.joint, TEMPERATURE, temperature_rows,
                       temperature_rows > 0 } };
  if (twin_topic != source.topic)
  {
    contents.lines.push_back({ twin_topic, TWIN, twins, twins > 0 });
  }
  rosbag::View telemetry(bag, rosbag::TopicQuery(source.topic));
  CheckedMessage message;
  for (const rosbag::MessageInstance& instance : telemetry)
  {
    if (message.read(instance))
    {
      contents.joints = message.state().name;
      break;
    }
  }
  const std::set<std::string> used{ source.topic, source.load_topic, twin_topic };
  std::set<std::string> others;
  rosbag::View all(bag);
  for (const rosbag::ConnectionInfo* connection : all.getConnections())
  {
    const bool is_temperature =
        temperature_rows > 0 && connection->datatype == ros::message_traits::datatype<sensor_msgs::Temperature>();
    if (!is_temperature && used.count(connection->topic) == 0)
    {
      others.insert(connection->topic);
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
  rosbag::Bag bag;
  openForReading(bag, source.path);
  rosbag::View view(bag, rosbag::TopicQuery(twin_topic));
  CheckedMessage message;
  const JointNames names(source.joint);
  for (const rosbag::MessageInstance& instance : view)
  {
    if (!message.read(instance))
    {
      continue;
    }
    const sensor_msgs::JointState& state = message.state();
    const std::size_t joint = placeOf(state, names.joint);
    const std::size_t motor = placeOf(state, names.motor);
    if (joint < std::min(state.position.size(), state.velocity.size()) && motor < state.effort.size())
    {
      states.add({ state.header.stamp.toSec() - start, state.position[joint], state.velocity[joint],
                   state.effort[motor] * source.current_per_motor_torque });
    }
  }
  return states;
}
}  // namespace hjt
