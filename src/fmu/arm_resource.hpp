// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "arm/arm_description.hpp"

namespace hjt::fmu
{
constexpr const char* ARM_FILE = "arm.yaml";  ///< among the resources; beside it a folder of each joint's drive

/// Data of an arm's description for the closed loop: links as numbers, gravity, payload, limits and gains. The
/// joints have gains.
std::string armResource(const ArmDescription& arm);

/// @throws ParameterError.
ArmDescription readArmResource(const std::string& path);
}  // namespace hjt::fmu
