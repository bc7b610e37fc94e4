// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "ros_io/parameter_server.hpp"
#include "ros_io/shutdown_signals.hpp"
#include "ros_io/tracker_node.hpp"
#include "ros_io/twin_node.hpp"

namespace
{
template <class Node>
void run(ros::NodeHandle& handle, const hjt::Parameters& parameters)
{
  const Node node(handle, parameters);
  ros::AsyncSpinner spinner(2);
  spinner.start();
  ros::waitForShutdown();
}
}  // namespace

int main(int argc, char** argv)
{
  ros::init(argc, argv, "joint_twin");
  hjt::shutDownOnSignals();
  // Outlives the try block: with the last handle ROS shuts down, and its console with it.
  ros::NodeHandle node("~");
  try
  {
    const hjt::Parameters parameters = hjt::parseParameters(hjt::readParameterServer(node.getNamespace()));
    ROS_INFO_STREAM("Parameters:\n" << hjt::describeParameters(parameters));
    if (parameters.input.mode == hjt::InputMode::COMMANDS)
    {
      run<hjt::TwinNode>(node, parameters);
    }
    else
    {
      run<hjt::TrackerNode>(node, parameters);
    }
  }
  catch (const hjt::ParameterError& error)
  {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
