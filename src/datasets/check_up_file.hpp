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
  std::string arm;              ///< name in config/arms, or a file
  std::string joint;            ///< that alone; empty: all, one after the other
  std::string out;              ///< file
  std::string format{ "csv" };  ///< csv, urscript or bag
  bool force{};                 ///< overwrite the file
};

void addOptions(OptionTable& table, CheckUpOptions& options);

/// The motion that was written.
struct CheckUpMotion
{
  std::string output;  ///< file
  double duration{};   ///< [s]
  std::size_t moves{};
  double largest_speed{};   ///< of a joint [rad/s]
  double largest_torque{};  ///< at an output [N.m]
};

/// Writes the motion in which an arm's faults are seen best (checkUpMoves), within its limits of speed and torque: as
/// table every 8 ms, as a program of URScript, or as trajectory_msgs/JointTrajectory on /joint_trajectory.
/// @throws ParameterError, InputError: a file that cannot be written.
CheckUpMotion writeCheckUp(const CheckUpOptions& options);

Report reportOf(const CheckUpMotion& motion);
}  // namespace hjt
