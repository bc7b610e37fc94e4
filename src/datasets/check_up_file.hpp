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
  std::string joint;            ///< name of a single joint; empty: all joints, one after the other
  std::string out;              ///< path of the file to write
  std::string format{ "csv" };  ///< format of the file: csv, urscript or bag
  bool force{};                 ///< whether an existing file is overwritten
};

void addOptions(OptionTable& table, CheckUpOptions& options);

struct CheckUpMotion
{
  std::string output;  ///< path of the file
  double duration{};   ///< duration of the motion [s]
  std::size_t moves{};
  double largest_speed{};   ///< largest speed of a joint [rad/s]
  double largest_torque{};  ///< largest torque at an output [N.m]
};

/// Writes the motion that shows the faults of an arm best (checkUpMoves), within the arm's limits of speed and torque.
/// The file is a table with a row every 8 ms, a URScript program, or a bag with trajectory_msgs/JointTrajectory on
/// /joint_trajectory. @throws ParameterError, or InputError if the file cannot be written.
CheckUpMotion writeCheckUp(const CheckUpOptions& options);

Report reportOf(const CheckUpMotion& motion);
}  // namespace hjt
