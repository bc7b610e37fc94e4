// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/driver_states.hpp"

#include <string>

#include <ros/serialization.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>
#include <topic_tools/shape_shifter.h>

namespace hjt
{
namespace
{
// github.com/UniversalRobots/Universal_Robots_ROS_Driver, ur_dashboard_msgs/msg: the texts, which the sums are of.
constexpr const char* ROBOT_MODE =
    "int8 NO_CONTROLLER=-1\nint8 DISCONNECTED=0\nint8 CONFIRM_SAFETY=1\nint8 BOOTING=2\n"
    "int8 POWER_OFF=3\nint8 POWER_ON=4\nint8 IDLE=5\nint8 BACKDRIVE=6\nint8 RUNNING=7\n"
    "int8 UPDATING_FIRMWARE=8\nint8 mode\n";
constexpr const char* ROBOT_MODE_SUM = "73b72d58742c4889c47118411b03a3b4";
constexpr std::uint8_t RUNNING = 7;
constexpr const char* SAFETY_MODE =
    "uint8 NORMAL=1\nuint8 REDUCED=2\nuint8 PROTECTIVE_STOP=3\nuint8 RECOVERY=4\nuint8 SAFEGUARD_STOP=5\n"
    "uint8 SYSTEM_EMERGENCY_STOP=6\nuint8 ROBOT_EMERGENCY_STOP=7\nuint8 VIOLATION=8\nuint8 FAULT=9\n"
    "uint8 VALIDATE_JOINT_ID=10\nuint8 UNDEFINED_SAFETY_MODE=11\nuint8 AUTOMATIC_MODE_SAFEGUARD_STOP=12\n"
    "uint8 SYSTEM_THREE_POSITION_ENABLING_STOP=13\nuint8 mode\n";
constexpr const char* SAFETY_MODE_SUM = "5da08725a63d4237bad689481131a84b";
constexpr std::uint8_t NORMAL = 1;
constexpr std::uint8_t PROTECTIVE_STOP = 3;

/// A mode is its one byte.
topic_tools::ShapeShifter makeMode(const char* sum, const char* type, const char* definition, std::uint8_t mode)
{
  topic_tools::ShapeShifter message;
  message.morph(sum, std::string("ur_dashboard_msgs/") + type, definition, "1");
  ros::serialization::IStream stream(&mode, 1);
  message.read(stream);
  return message;
}

topic_tools::ShapeShifter makeRobotMode()
{
  return makeMode(ROBOT_MODE_SUM, "RobotMode", ROBOT_MODE, RUNNING);
}

topic_tools::ShapeShifter makeSafetyMode(bool protective_stop)
{
  return makeMode(SAFETY_MODE_SUM, "SafetyMode", SAFETY_MODE, protective_stop ? PROTECTIVE_STOP : NORMAL);
}
}  // namespace

DriverStates::DriverStates(const ros::NodeHandle& parent)
  : parent_(parent)
  , robot_mode_(makeRobotMode().advertise(parent_, "ur_hardware_interface/robot_mode", 1, true))
  , safety_mode_(makeSafetyMode(false).advertise(parent_, "ur_hardware_interface/safety_mode", 1, true))
  , program_(parent_.advertise<std_msgs::Bool>("ur_hardware_interface/robot_program_running", 1, true))
  , speed_scaling_(parent_.advertise<std_msgs::Float64>("speed_scaling_factor", 1, true))
{
  robot_mode_.publish(makeRobotMode());
  show(false);
}

void DriverStates::show(bool protective_stop)
{
  if (shown_ == protective_stop)
  {
    return;
  }
  shown_ = protective_stop;
  safety_mode_.publish(makeSafetyMode(protective_stop));
  std_msgs::Bool program;
  program.data = !protective_stop;
  program_.publish(program);
  std_msgs::Float64 scaling;
  scaling.data = protective_stop ? 0.0 : 1.0;
  speed_scaling_.publish(scaling);
}
}  // namespace hjt
