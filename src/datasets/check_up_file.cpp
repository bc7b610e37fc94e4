// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/check_up_file.hpp"

#include <algorithm>
#include <cmath>

#include <trajectory_msgs/JointTrajectory.h>

#include "output/output_file.hpp"
#include "output/process_end.hpp"

#include "arm/arm_configuration.hpp"
#include "arm/arm_motion.hpp"
#include "bags/bag_writer.hpp"
#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr double PERIOD = 0.008;  // sampling period of a UR controller [s]
/// The following limits apply to the motion from the check-up of one joint to that of the next.
constexpr double TRANSFER_SPEED = 0.35;         // largest speed of a joint [rad/s]
constexpr double TRANSFER_ACCELERATION = 0.35;  // largest acceleration of a joint [rad/s^2]
constexpr const char* TOPIC = "/joint_trajectory";

std::vector<ArmMove> movesOf(const ArmDescription& arm, const std::string& name)
{
  std::vector<ArmMove> moves;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    if (name.empty() || name == arm.joints[i].short_name || name == arm.joints[i].name)
    {
      const std::vector<ArmMove> own = checkUpMoves(arm, i);
      moves.push_back({ own.back().target, TRANSFER_SPEED, TRANSFER_ACCELERATION });
      moves.insert(moves.end(), own.begin(), own.end());
    }
  }
  if (moves.empty())
  {
    throw ParameterError(arm.origin + " has no joint '" + name + "'");
  }
  return moves;
}

void writeMotionCsv(const std::string& path, const ArmDescription& arm, const std::vector<ArmInstant>& instants)
{
  std::vector<std::string> columns{ "time" };
  for (const ArmJoint& joint : arm.joints)
  {
    for (const char* quantity : { "_position", "_velocity", "_acceleration", "_torque" })
    {
      columns.push_back(joint.short_name + quantity);
    }
  }
  CsvWriter file(path, columns);
  for (const ArmInstant& instant : instants)
  {
    std::vector<double> row{ instant.time };
    for (std::size_t i = 0; i < arm.joints.size(); ++i)
    {
      const JointMotion& joint = instant.joints[i];
      row.insert(row.end(), { joint.position, joint.velocity, joint.acceleration, instant.torques[i] });
    }
    file.writeRow(row);
  }
  file.close();
}

void writeUrScript(const std::string& path, const std::vector<ArmMove>& moves)
{
  TextStream text;
  text << "# Check-up. The arm moves to the first pose from any position, so keep its surroundings clear.\n"
          "def check_up():\n";
  for (const ArmMove& move : moves)
  {
    text << "  movej([";
    for (std::size_t i = 0; i < move.target.size(); ++i)
    {
      text << (i > 0 ? ", " : "") << numberText(move.target[i]);
    }
    text << "], a=" << numberText(move.acceleration) << ", v=" << numberText(move.speed) << ")\n";
  }
  text << "end\ncheck_up()\n";
  writeTextFile(path, text.str());
}

void writeTrajectory(const std::string& path, const ArmDescription& arm, const std::vector<ArmInstant>& instants)
{
  trajectory_msgs::JointTrajectory trajectory;
  for (const ArmJoint& joint : arm.joints)
  {
    trajectory.joint_names.push_back(joint.name);
  }
  for (const ArmInstant& instant : instants)
  {
    trajectory_msgs::JointTrajectoryPoint point;
    point.time_from_start = ros::Duration(instant.time);
    for (const JointMotion& joint : instant.joints)
    {
      point.positions.push_back(joint.position);
      point.velocities.push_back(joint.velocity);
      point.accelerations.push_back(joint.acceleration);
    }
    trajectory.points.push_back(point);
  }
  BagWriter bag(path);
  bag.write(TOPIC, SIMULATION_EPOCH, trajectory);  // stamp 0: the motion begins when the message is received
  bag.close();
}
}  // namespace

void addOptions(OptionTable& table, CheckUpOptions& options)
{
  table.add("--arm", options.arm, "name of an arm in config/arms, or a file").required().type("NAME|FILE.yaml");
  table
      .add("--joint", options.joint,
           "a single joint, for example base or shoulder; default: all joints, one after the other")
      .type("NAME");
  table.add("--out", options.out, "file of the motion").required().type("FILE");
  table
      .add("--format", options.format,
           "csv: angles, rates and torques every 8 ms; urscript: a program; bag: trajectory_msgs/JointTrajectory on "
           "/joint_trajectory")
      .choice({ "csv", "urscript", "bag" });
  addOptions(table, options, options.force);
}

CheckUpMotion writeCheckUp(const CheckUpOptions& options)
{
  requireWritable(options.out, options.force);
  const ArmDescription arm = readArmDescription(findArm(options.arm, configDirectory(options)));
  const std::vector<ArmMove> moves = movesOf(arm, options.joint);
  const std::vector<ArmInstant> instants = sampleMoves(arm, moves.front().target, moves, PERIOD);
  if (options.format == "csv")
  {
    writeMotionCsv(options.out, arm, instants);
  }
  else if (options.format == "urscript")
  {
    writeUrScript(options.out, moves);
  }
  else
  {
    writeTrajectory(options.out, arm, instants);
  }
  CheckUpMotion motion{ options.out, instants.back().time, moves.size() };
  for (const ArmInstant& instant : instants)
  {
    for (std::size_t i = 0; i < arm.joints.size(); ++i)
    {
      motion.largest_speed = std::max(motion.largest_speed, std::abs(instant.joints[i].velocity));
      motion.largest_torque = std::max(motion.largest_torque, std::abs(instant.torques[i]));
    }
  }
  return motion;
}

Report reportOf(const CheckUpMotion& motion)
{
  return { { { "output", "", motion.output },
             { "duration", "duration [s]", motion.duration },
             { "moves", "moves", motion.moves },
             { "largest_speed", "largest speed of a joint [rad/s]", motion.largest_speed },
             { "largest_torque", "largest torque at an output [N.m]", motion.largest_torque } },
           {} };
}
}  // namespace hjt
