// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "recordings/recorded_motion.hpp"

namespace hjt
{
/// The header of a recording's table with the names of a controller's columns in place of its own: a time named `time`,
/// `t` or `__time`, and what PlotJuggler exports of a JointState, `/joint_states/elbow_joint/position`. Other columns
/// keep their names.
std::vector<std::string> controllerColumns(std::vector<std::string> header);

/// The program that wrote the file, and how its data can be read, as a clause; empty: not known.
std::string foreignTable(const std::vector<std::string>& header);

/// What a recording says besides its rows; of messages the first alone.
struct RecordedStatements
{
  bool has_load{};
  /// Torque per current that the controller of an arm counts with: the ratio of its columns `target_moment_N` and
  /// `target_current_N` while the whole arm is at rest, where its current holds no friction; of the first minutes. One
  /// for each of six joints [N.m/A]. NaN: the joint bears no load at rest. Empty: not recorded.
  std::vector<double> gains;
  /// Columns payload [kg] and payload_cog_0 ... 2 [m]; none: not recorded, or another in some rows.
  std::optional<Payload> payload;
};

/// `of_arm`: else it is not asked for gains and payload. @throws InputError on an unreadable file.
RecordedStatements readStatements(const MotionSource& source, bool of_arm);
}  // namespace hjt
