// SPDX-License-Identifier: BSD-3-Clause
// Node that draws a twin's drive in rviz, from the contact forces that the twin publishes.
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include <dynamic_reconfigure/server.h>
#include <ros/ros.h>

#include "harmonic_joint_twin/DriveMarkersConfig.h"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "ros_io/drive_markers.hpp"
#include "ros_io/node_environment.hpp"
#include "ros_io/parameter_server.hpp"

namespace
{
/// Reads a positive number from the parameter server. @throws hjt::ParameterError if there is none.
double readPositive(const ros::NodeHandle& node, const std::string& name, const std::string& unit)
{
  double value = 0.0;
  if (!node.getParam(name, value) || !(value > 0.0))
  {
    throw hjt::ParameterError(node.resolveName(name) + ": a positive number [" + unit + "] is required");
  }
  return value;
}

/// Reads a text from the parameter server. @throws hjt::ParameterError if the text is missing or empty.
std::string readText(const ros::NodeHandle& node, const std::string& name, const std::string& meaning)
{
  std::string value;
  if (!node.getParam(name, value) || value.empty())
  {
    throw hjt::ParameterError(node.resolveName(name) + ": " + meaning + " is required");
  }
  return value;
}

/// Replaces a value that is not finite by the present value. dynamic_reconfigure has checked the range.
void refuseUnlessFinite(double& value, double present, const char* name)
{
  if (!std::isfinite(value))
  {
    ROS_ERROR_STREAM(name << " = " << value << " is not a finite number; the value stays " << present);
    value = present;
  }
}

hjt::DriveMarkers readMarkers(const ros::NodeHandle& node)
{
  const std::string twin = ros::names::resolve(readText(node, "twin", "the name of the twin's node"));
  const hjt::Parameters parameters = hjt::parseParameters(hjt::readParameterServer(twin));
  return { parameters,
           { readText(node, "frame", "the frame of the markers"), readPositive(node, "exaggeration", "-"),
             readPositive(node, "arrow_length", "m/N"), readPositive(node, "full_force", "N") } };
}
}  // namespace

int main(int argc, char** argv)
{
  ros::init(argc, argv, "drive_markers");
  hjt::shutDownOnSignals();
  ros::NodeHandle node("~");
  try
  {
    hjt::DriveMarkers markers = readMarkers(node);
    using Config = harmonic_joint_twin::DriveMarkersConfig;
    dynamic_reconfigure::Server<Config> server(node);
    server.setCallback(
        [&markers](Config& config, std::uint32_t)
        {
          const hjt::MarkerStyle present = markers.style();
          refuseUnlessFinite(config.exaggeration, present.exaggeration, "exaggeration");
          refuseUnlessFinite(config.arrow_length, present.arrow_length, "arrow_length");
          refuseUnlessFinite(config.full_force, present.full_force, "full_force");
          markers.setStyle({ present.frame, config.exaggeration, config.arrow_length, config.full_force });
        });
    ros::Publisher publisher = node.advertise<visualization_msgs::MarkerArray>("markers", 1);
    const ros::Subscriber subscriber = ros::NodeHandle().subscribe<harmonic_joint_twin::ContactForces>(
        "contact_forces", 1,
        [&markers, &publisher](const harmonic_joint_twin::ContactForces::ConstPtr& forces)
        {
          try
          {
            publisher.publish(markers.draw(*forces));
          }
          catch (const std::invalid_argument& error)
          {
            ROS_ERROR_STREAM_THROTTLE(5.0, error.what());
          }
        });
    ros::spin();
  }
  catch (const hjt::ParameterError& error)
  {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
