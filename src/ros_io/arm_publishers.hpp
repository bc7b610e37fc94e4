// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include "arm/moving_arm.hpp"
#include "ros_io/output_publishers.hpp"
#include "ros_io/publisher_thread.hpp"

namespace hjt
{
/// What the twin of an arm publishes: joint_states as the robot's driver does, the tool's pose and the wanted one, and
/// of each drive what the twin of a joint publishes, below its own name.
class ArmPublishers
{
public:
  ArmPublishers(ros::NodeHandle& node, const ArmDescription& arm, const ArmTwin& twin);

  /// Loop: fills the messages due at the present instant that somebody hears. No allocation, no lock.
  void offer(MovingArm& arm) noexcept;

  /// Loop: as OutputPublishers::finishCycle.
  Stamp finishCycle(Stamp instant) noexcept;

  /// Messages that could not be published.
  std::uint64_t dropped() const noexcept;

private:
  using Pose = geometry_msgs::PoseStamped;

  bool isHeard() const noexcept;
  void drain();

  ros::NodeHandle parent_;
  std::vector<std::size_t> order_;  // joints in that of the driver's messages
  Stamp period_;                    // [ns]
  ArmDynamics dynamics_;
  std::vector<JointMotion> wanted_;
  std::vector<std::unique_ptr<OutputPublishers>> drives_;
  OutputChannel<sensor_msgs::JointState> states_;
  OutputChannel<Pose> tool_;
  OutputChannel<Pose> wanted_tool_;
  PublisherThread thread_;  // last: it uses the rest
};
}  // namespace hjt
