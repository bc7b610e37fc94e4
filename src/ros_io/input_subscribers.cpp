// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/input_subscribers.hpp"

#include <ros/console.h>

#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "ros_io/input_topics.hpp"
#include "ros_io/warning_period.hpp"

namespace hjt
{
InputSubscribers::InputSubscribers(ros::NodeHandle& node, const Twin& twin, Inbox& inbox)
  : names_(twin.parameters().joint.name), inbox_(inbox), faults_(InputTopics{ node, too_large_ }, twin, inbox)
{
  using sensor_msgs::JointState;
  using std_msgs::Float64;
  const InputTopics inputs{ node, too_large_ };
  subscribers_ = {
    inputs.subscribe<Float64>(topics::MOTOR_TORQUE_COMMAND,
                              [this](const auto& event) { receiveNow(InputKind::MOTOR_TORQUE, event); }),
    inputs.subscribe<Float64>(topics::LOAD_TORQUE,
                              [this](const auto& event) { receiveNow(InputKind::LOAD_TORQUE, event); }),
    inputs.subscribe<JointState>(topics::COMMAND, [this](const auto& event) { receiveCommand(*event.getMessage()); }),
    inputs.subscribe<JointState>(topics::LOAD, [this](const auto& event) { receiveLoad(*event.getMessage()); }),
  };
}

void InputSubscribers::receiveNow(InputKind kind, const ros::MessageEvent<const std_msgs::Float64>& event)
{
  inbox_.push(Input{ fromRosTime(event.getReceiptTime()), kind, event.getMessage()->data });
}

void InputSubscribers::receiveCommand(const sensor_msgs::JointState& message)
{
  double torque = 0.0;
  const EffortStatus status = readMotorTorque(message, names_, torque);
  if (status == EffortStatus::FOUND)
  {
    receiveStamped(InputKind::MOTOR_TORQUE, message.header.stamp, torque);
    return;
  }
  refuse(status, topics::COMMAND, names_.joint + " or " + names_.motor);
}

void InputSubscribers::receiveLoad(const sensor_msgs::JointState& message)
{
  double torque = 0.0;
  const EffortStatus status = readLoadTorque(message, names_, torque);
  if (status == EffortStatus::FOUND)
  {
    receiveStamped(InputKind::LOAD_TORQUE, message.header.stamp, torque);
    return;
  }
  refuse(status, topics::LOAD, names_.joint);
}

void InputSubscribers::receiveStamped(InputKind kind, const ros::Time& stamp, double torque)
{
  inbox_.push(Input{ stampOr(stamp, ros::Time::now()), kind, torque });
}

void InputSubscribers::refuse(EffortStatus status, const char* topic, const std::string& expected)
{
  if (status == EffortStatus::UNKNOWN_JOINT)
  {
    ++unknown_joint_;
    ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "Refused a message on ~" << topic << ": it does not name " << expected);
  }
  else
  {
    ++missing_effort_;
    ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "Refused a message on ~" << topic << ": no effort for " << expected);
  }
}
}  // namespace hjt
