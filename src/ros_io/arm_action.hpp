// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "ros_io/arm_node.hpp"

namespace hjt
{
/// Offers the action FollowJointTrajectory below the controller's name, `~controller`, as the arm's driver does, for as
/// long as what it returns lives. Where control_msgs was not found nothing, and the log says so.
std::shared_ptr<void> offerArmAction(ros::NodeHandle& node, ArmNode& arm);

/// The live twin of an arm with its action.
class ArmWithAction
{
public:
  ArmWithAction(ros::NodeHandle& node, const ArmDescription& arm, const std::vector<Parameters>& drives)
    : arm_(node, arm, drives), action_(offerArmAction(node, arm_))
  {
  }

private:
  ArmNode arm_;
  std::shared_ptr<void> action_;
};
}  // namespace hjt
