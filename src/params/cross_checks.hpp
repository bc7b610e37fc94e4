// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Contradictions between parameters that are each in range; one text each. `map` has their origins.
std::vector<std::string> contradictions(const Parameters& parameters, const ParameterMap& map);
}  // namespace hjt
