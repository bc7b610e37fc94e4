// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "output/report.hpp"
#include "twin/options.hpp"

namespace hjt
{
struct CheckUpOptions : ConfigurationOptions
{
  std::string arm;              ///< name of a shipped arm, or path of its file
  std::string joint;            ///< a single joint; empty: all joints, one after the other
  std::string out;              ///< file
  std::string format{ "csv" };  ///< csv, urscript or bag
  bool force{};                 ///< overwrite an existing file
};

void addOptions(OptionTable& table, CheckUpOptions& options);

struct CheckUpMotion
{
  std::string output;  ///< path of the file
  double duration{};   ///< [s]
  std::size_t moves{};
  double largest_speed{};   ///< largest speed of a joint [rad/s]
  double largest_torque{};  ///< largest torque at an output [N.m]
};

/// Writes the motion that shows an arm's faults best (checkUpMoves), within its limits of speed and torque: as a table
/// every 8 ms, as a URScript program, or as trajectory_msgs/JointTrajectory on /joint_trajectory.
/// @throws ParameterError, or InputError if the file cannot be written.
CheckUpMotion writeCheckUp(const CheckUpOptions& options);

Report reportOf(const CheckUpMotion& motion);
}  // namespace hjt
