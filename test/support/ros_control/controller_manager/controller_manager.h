// SPDX-License-Identifier: BSD-3-Clause
/// As joint_state_interface.h, of the package controller_manager; without controllers.
#pragma once

#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>

namespace controller_manager
{
class ControllerManager
{
public:
  explicit ControllerManager(hardware_interface::RobotHW* /*hardware*/,
                             const ros::NodeHandle& /*node*/ = ros::NodeHandle())
  {
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/, bool /*reset_controllers*/ = false) {}
};
}  // namespace controller_manager
