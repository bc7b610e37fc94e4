// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_motion.hpp"

namespace hjt
{
/// Set points of a program, a YAML file of moves between via points (docs/arm_twin.md), 125 a second. The arm rests for
/// half a second before and after. @throws ParameterError naming file, line and key, or the joint and its limit.
std::vector<ArmSetPoint> readArmProgram(const std::string& path, const ArmDescription& arm);
}  // namespace hjt
