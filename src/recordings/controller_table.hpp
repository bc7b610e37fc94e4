// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "recordings/recorded_motion.hpp"

namespace hjt
{
/// Converts names of columns to those of a controller's recording: `time`, `Time`, `t` and `__time` to `timestamp`, and
/// PlotJuggler's names for a JointState, such as `/joint_states/elbow_joint/position`. Other columns keep their names.
std::vector<std::string> controllerColumns(std::vector<std::string> header);

/// Clause on which program wrote an unreadable table, and which file to give instead; empty for an unknown program.
std::string foreignTable(const std::vector<std::string>& header);

/// Statements of a recording besides its rows. A recording of messages states only whether it has a load.
struct RecordedStatements
{
  bool has_load{};
  /// Torque per current of each of six joints, as the controller states it [N.m/A]: the ratio of the columns
  /// `target_moment_N` and `target_current_N` in the first 50 000 rows, where the whole arm is at rest. At rest the
  /// current contains no friction. NaN if the joint bears no load at rest. Empty if the columns are not recorded.
  std::vector<double> gains;
  /// Payload from the columns payload [kg] and payload_cog_0, _1, _2 [m]; none if they are missing or values change.
  std::optional<Payload> payload;
};

/// Reads the statements of a recording. Gains and payload are read only if the recording is `of_arm`, that is, of a
/// whole arm. @throws InputError if the file is unreadable.
RecordedStatements readStatements(const MotionSource& source, bool of_arm);
}  // namespace hjt
