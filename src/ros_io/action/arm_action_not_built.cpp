// SPDX-License-Identifier: BSD-3-Clause
#include <ros/console.h>

#include "ros_io/arm_node.hpp"

namespace hjt
{
std::shared_ptr<void> offerArmAction(ros::NodeHandle& /*node*/, ArmNode& /*arm*/)
{
  ROS_INFO_STREAM("No action FollowJointTrajectory: control_msgs or actionlib was not found at build time");
  return {};
}
}  // namespace hjt
