// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>

#include <ros/ros.h>

#include "harmonic_joint_twin/params/parameter_error.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/ros_io/parameter_server.hpp"
#include "harmonic_joint_twin/ros_io/twin_node.hpp"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "joint_twin");
  // roscpp catches SIGINT only.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  // Outlives the try block: with the last handle ROS shuts down, and its console with it.
  ros::NodeHandle node("~");
  try
  {
    const hjt::Parameters parameters = hjt::parseParameters(hjt::readParameterServer(node.getNamespace()));
    ROS_INFO_STREAM("Parameters:\n" << hjt::describeParameters(parameters));
    hjt::TwinNode twin_node(node, parameters);
    ros::AsyncSpinner spinner(2);
    spinner.start();
    ros::waitForShutdown();
  }
  catch (const hjt::ParameterError& error)
  {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
