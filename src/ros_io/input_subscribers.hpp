// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>

#include "live/inbox.hpp"
#include "messages/conversions.hpp"
#include "ros_io/fault_subscriber.hpp"

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
  InputSubscribers(ros::NodeHandle& node, const Twin& twin, Inbox& inbox);

  MessageCounters counters() const noexcept
  {
    return { unknown_joint_, missing_effort_, faults_.refused(), too_large_ };
  }

private:
  void receiveNow(InputKind kind, const ros::MessageEvent<const std_msgs::Float64>& event);
  void receiveCommand(const sensor_msgs::JointState& message);
  void receiveLoad(const sensor_msgs::JointState& message);
  void receiveStamped(InputKind kind, const ros::Time& stamp, double torque);
  void refuse(EffortStatus status, const char* topic, const std::string& expected);

  const JointNames names_;
  Inbox& inbox_;
  std::atomic<std::uint64_t> unknown_joint_{ 0 };
  std::atomic<std::uint64_t> missing_effort_{ 0 };
  std::atomic<std::uint64_t> too_large_{ 0 };
  FaultSubscriber faults_;
  std::array<ros::Subscriber, 4> subscribers_;
};
}  // namespace hjt
