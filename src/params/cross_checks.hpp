// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// What two parameters, each in its range, contradict each other in; one text each. `map` tells where they came from.
std::vector<std::string> contradictions(const Parameters& parameters, const ParameterMap& map);
}  // namespace hjt
