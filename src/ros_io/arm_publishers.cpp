// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/arm_publishers.hpp"

#include <algorithm>
#include <limits>

#include <ros/names.h>

#include "arm/arm_configuration.hpp"
#include "messages/channels.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "ros_io/joint_name.hpp"

namespace hjt
{
namespace
{
constexpr const char* TOOL_POSE = "tool_pose";
constexpr const char* WANTED_TOOL_POSE = "wanted_tool_pose";

template <class Message>
Channel<Message> channelOf(const char* name)
{
  return { name, nullptr, SMALL_MESSAGE_SLOTS, nullptr, nullptr };
}

geometry_msgs::PoseStamped makePose(const ArmDescription& arm)
{
  geometry_msgs::PoseStamped message;
  message.header.frame_id = arm.base;
  return message;
}

bool fillPose(Stamp stamp, const ToolPose& pose, geometry_msgs::PoseStamped& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.pose.position.x = pose.position[0];
  message.pose.position.y = pose.position[1];
  message.pose.position.z = pose.position[2];
  message.pose.orientation.x = pose.orientation[0];
  message.pose.orientation.y = pose.orientation[1];
  message.pose.orientation.z = pose.orientation[2];
  message.pose.orientation.w = pose.orientation[3];
  return true;
}
}  // namespace

ArmPublishers::ArmPublishers(ros::NodeHandle& node, const ArmDescription& arm, const ArmTwin& twin)
  : order_(driverOrder(arm))
  , period_(publishPeriod(arm.state_rate, twin.drive(0).parameters().solver.rate))
  , dynamics_(arm)
  , wanted_(arm.joints.size())
  , states_(&parent_, channelOf<sensor_msgs::JointState>(topics::JOINT_STATES), jointStatesOf(driverNames(arm)))
  , tool_(&node, channelOf<Pose>(TOOL_POSE), makePose(arm))
  , wanted_tool_(&node, channelOf<Pose>(WANTED_TOOL_POSE), makePose(arm))
  , thread_([this] { drain(); }, [this] { return isHeard(); })
{
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    ros::NodeHandle joint(jointName(arm.joints[i]));
    drives_.push_back(std::make_unique<OutputPublishers>(joint, twin.drive(i)));
  }
}

void ArmPublishers::offer(MovingArm& arm) noexcept
{
  for (std::size_t i = 0; i < drives_.size(); ++i)
  {
    drives_[i]->offer(arm.twin().drive(i));
  }
  const Stamp stamp = arm.twin().stamp();
  if (stamp % period_ != 0)
  {
    return;
  }
  if (states_.isWanted())
  {
    states_.write(
        [&](sensor_msgs::JointState& message)
        {
          message.header.stamp = toRosTime(stamp);
          for (std::size_t k = 0; k < order_.size(); ++k)
          {
            const JointReading reading = arm.reading(order_[k]);
            message.position[k] = reading.position;
            message.velocity[k] = reading.velocity;
            message.effort[k] = reading.current;
          }
          return true;
        });
  }
  if (tool_.isWanted())
  {
    tool_.write([&](Pose& message) { return fillPose(stamp, arm.twin().toolPose(), message); });
  }
  if (wanted_tool_.isWanted())
  {
    arm.wanted(wanted_);
    wanted_tool_.write([&](Pose& message) { return fillPose(stamp, dynamics_.toolPose(wanted_), message); });
  }
}

Stamp ArmPublishers::finishCycle(Stamp instant) noexcept
{
  Stamp next = std::numeric_limits<Stamp>::max() / 2;
  for (const auto& drive : drives_)
  {
    next = std::min(next, drive->finishCycle(instant));
  }
  if (isHeard())
  {
    thread_.wakeUp();
    next = std::min(next, (instant / period_ + 1) * period_);
  }
  return next;
}

std::uint64_t ArmPublishers::dropped() const noexcept
{
  std::uint64_t sum = states_.counters("").dropped + tool_.counters("").dropped + wanted_tool_.counters("").dropped;
  for (const auto& drive : drives_)
  {
    for (const ChannelCounters& channel : drive->counters())
    {
      sum += channel.dropped;
    }
  }
  return sum;
}

bool ArmPublishers::isHeard() const noexcept
{
  return states_.isWanted() || tool_.isWanted() || wanted_tool_.isWanted();
}

void ArmPublishers::drain()
{
  states_.drain();
  tool_.drain();
  wanted_tool_.drain();
}
}  // namespace hjt
