// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
/// References as YAML: a list `baseline` of operating bins, and for each indicator its `[windows, mean, spread]`.

/// @throws InputError naming the file, and what in it is wrong.
std::vector<ReferenceBin> readBaseline(const std::string& path);

/// @throws InputError if the file cannot be written.
void writeBaseline(const std::string& path, const std::vector<ReferenceBin>& bins);
}  // namespace hjt
