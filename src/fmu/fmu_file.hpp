// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt::fmu
{
/// A co-simulation unit of FMI 3.0 of this drive, as the bytes of its file. `library`: path of that with FMI's
/// functions; `others`: paths of what it loads and a system may lack. Files that parameters name go into the unit.
/// @throws InputError.
std::string fmuFile(Parameters parameters, const std::string& library, const std::vector<std::string>& others);
}  // namespace hjt::fmu
