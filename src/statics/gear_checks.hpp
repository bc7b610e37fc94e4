// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Why the gear cannot turn, sound and as drawn: its teeth jam without load. Empty if they do not.
std::string jamOf(const Parameters& parameters);

/// Inconsistent values, one text each: key, value, and what it should be near; a jam comes alone. They take a few
/// equilibria, some 10 ms.
std::vector<std::string> gearWarnings(const Parameters& parameters);
}  // namespace hjt
