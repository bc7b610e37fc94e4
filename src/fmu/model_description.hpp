// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "fmu/variables.hpp"

namespace hjt::fmu
{
constexpr const char* MODEL_IDENTIFIER = "harmonic_joint_twin";  ///< of the library in the unit, without its ending

/// FMI 3.0's modelDescription.xml of the drive. `token`: see instantiationToken.
std::string modelDescription(const Parameters& parameters, const std::string& token);
}  // namespace hjt::fmu
