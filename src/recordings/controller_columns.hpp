// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace hjt
{
/// The header of a recording's table with the names of a controller's columns in place of its own: a time named `time`,
/// `t` or `__time`, and what PlotJuggler exports of a JointState, `/joint_states/elbow_joint/position`. Other columns
/// keep their names.
std::vector<std::string> controllerColumns(std::vector<std::string> header);

/// The program that wrote the file, and how its data can be read, as a clause; empty: not known.
std::string foreignTable(const std::vector<std::string>& header);
}  // namespace hjt
