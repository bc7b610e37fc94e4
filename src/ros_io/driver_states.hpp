// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <ros/node_handle.h>
#include <ros/publisher.h>

namespace hjt
{
/// State of the robot as ur_robot_driver publishes it, by its names, latched: robot and safety mode, whether it takes
/// commands, the share of its speed. The modes are messages of ur_dashboard_msgs, which need not be there.
class DriverStates
{
public:
  /// `parent`: of the driver's names.
  explicit DriverStates(const ros::NodeHandle& parent);

  /// Publishes what has changed.
  void show(bool protective_stop);

private:
  std::optional<bool> shown_;
  ros::NodeHandle parent_;
  ros::Publisher robot_mode_;
  ros::Publisher safety_mode_;
  ros::Publisher program_;
  ros::Publisher speed_scaling_;
};
}  // namespace hjt
