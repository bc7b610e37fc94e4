// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
/// A file of references is YAML. `load_step` is the width of a class of load [N.m], `model` says whether the twin's
/// indicators were subtracted from the windows, and `baseline` is a list of operating points. Each operating point has
/// a row `[windows, mean, spread, ...]` for each indicator.

/// Reads a file of references. `less_model`: whether the caller subtracts the twin's indicators from its windows.
/// @throws InputError with file and reason if the file is invalid, if its load step is not that of the gear, or if its
/// `model` is not `less_model`.
std::vector<ReferenceBin> readBaseline(const std::string& path, const Parameters& parameters, bool less_model);

/// @throws InputError if the file cannot be written.
void writeBaseline(const std::string& path, const Baseline& baseline, bool less_model);
}  // namespace hjt
