// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "recordings/recorded_motion.hpp"

namespace hjt
{
/// Renames the columns of a table to those of a controller's recording. Known names are `time`, `t` and `__time` for
/// the time, and those that PlotJuggler gives to a JointState, as `/joint_states/elbow_joint/position`. Other columns
/// keep their names.
std::vector<std::string> controllerColumns(std::vector<std::string> header);

/// Clause that says which program wrote a table that cannot be read, and how its data can be read; empty if the program
/// is not known.
std::string foreignTable(const std::vector<std::string>& header);

/// What a recording states besides its rows. A recording of messages states only whether it has a load.
struct RecordedStatements
{
  bool has_load{};
  /// Torque per current of each of six joints by the controller [N.m/A]: the ratio of the columns `target_moment_N` and
  /// `target_current_N` in the first minutes while the whole arm is at rest, where the current holds no friction. NaN
  /// if the joint bears no load at rest. Empty if the columns are not recorded.
  std::vector<double> gains;
  /// Payload by the columns payload [kg] and payload_cog_0, _1 and _2 [m]; none if they are not recorded or change.
  std::optional<Payload> payload;
};

/// Reads the statements of a recording; gains and payload are read only if it is `of_arm`. @throws InputError if the
/// file is unreadable.
RecordedStatements readStatements(const MotionSource& source, bool of_arm);
}  // namespace hjt
