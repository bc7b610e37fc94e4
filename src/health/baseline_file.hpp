// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
/// A file of references is YAML with `load_step`, the step between two classes of load [N.m], with `model`, whether a
/// model's indicators were subtracted, and with a list `baseline` of operating points. Each of them has `[windows,
/// mean, spread, ...]` of each indicator.

/// `less_model`: whether a model's indicators are subtracted from the windows.
/// @throws InputError naming the file and what in it is wrong: also if its load step is not that of the gear, or if a
/// model was subtracted and none is given here, or the other way round.
std::vector<ReferenceBin> readBaseline(const std::string& path, const Parameters& parameters, bool less_model);

/// @throws InputError if the file cannot be written.
void writeBaseline(const std::string& path, const Baseline& baseline, bool less_model);
}  // namespace hjt
