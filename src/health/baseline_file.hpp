// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
/// References as YAML: `load_step`, between two classes of load [N.m], and a list `baseline` of operating bins, with
/// `[windows, mean, spread]` of each indicator.

/// @throws InputError naming the file, and what in it is wrong; also if its load step is not that of the gear.
std::vector<ReferenceBin> readBaseline(const std::string& path, const Parameters& parameters);

/// @throws InputError if the file cannot be written.
void writeBaseline(const std::string& path, const Baseline& baseline);
}  // namespace hjt
