// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include <ros/console.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>

#include "live/inbox.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "ros_io/fault_subscriber.hpp"
#include "ros_io/input_topics.hpp"
#include "ros_io/warning_period.hpp"

namespace hjt
{
/// Messages that held no torque or fault for this joint, since start.
struct MessageCounters
{
  std::uint64_t unknown_joint{};   ///< neither the joint nor, in a command, its motor was named
  std::uint64_t missing_effort{};  ///< named, but without an effort
  std::uint64_t refused_fault{};   ///< of unknown kind, or severity or place out of its range
  std::uint64_t too_large{};       ///< of more bytes than InputTopics reads
};

/// Subscribes the topics of torques and faults and puts what they bring, stamped, into the inbox.
/// A message without a stamp counts as made when it is received.
class InputSubscribers
{
public:
  InputSubscribers(ros::NodeHandle& node, const Twin& twin, Inbox& inbox)
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

  MessageCounters counters() const noexcept
  {
    return { unknown_joint_, missing_effort_, faults_.refused(), too_large_ };
  }

private:
  void receiveNow(InputKind kind, const ros::MessageEvent<const std_msgs::Float64>& event)
  {
    inbox_.push(Input{ fromRosTime(event.getReceiptTime()), kind, event.getMessage()->data });
  }

  void receiveCommand(const sensor_msgs::JointState& message)
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

  void receiveLoad(const sensor_msgs::JointState& message)
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

  void receiveStamped(InputKind kind, const ros::Time& stamp, double torque)
  {
    inbox_.push(Input{ stampOr(stamp, ros::Time::now()), kind, torque });
  }

  void refuse(EffortStatus status, const char* topic, const std::string& expected)
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

  const JointNames names_;
  Inbox& inbox_;
  std::atomic<std::uint64_t> unknown_joint_{ 0 };
  std::atomic<std::uint64_t> missing_effort_{ 0 };
  std::atomic<std::uint64_t> too_large_{ 0 };
  FaultSubscriber faults_;
  std::array<ros::Subscriber, 4> subscribers_;
};
}  // namespace hjt
