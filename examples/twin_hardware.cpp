// SPDX-License-Identifier: BSD-3-Clause
// The loop of ros_control on a twin: controllers are loaded and started as on a robot, by controller_manager's spawner.
// Usage: twin_hardware CONFIG_DIR    (the package's folder config)
#include <controller_manager/controller_manager.h>
#include <ros/ros.h>

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/ros_control/twin_hardware.hpp"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "twin_hardware");
  ros::NodeHandle node;
  hjt::ParameterMap map;
  hjt::readDefaultConfiguration(argc > 1 ? argv[1] : "config", map);
  hjt::Twin twin(hjt::parseParameters(map), { hjt::surfaceCacheDirectory() });
  hjt::TwinHardware hardware("elbow_joint", twin);
  controller_manager::ControllerManager manager(&hardware, node);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const ros::Duration period(0.001);
  for (ros::Rate rate(period); ros::ok(); rate.sleep())
  {
    const ros::Time now = ros::Time::now();
    hardware.read(now, period);
    manager.update(now, period);
    hardware.write(now, period);
  }
  return 0;
}
