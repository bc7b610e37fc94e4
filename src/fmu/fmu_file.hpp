// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "fmu/fmi.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt::fmu
{
/// Files of libraries for a unit.
struct UnitLibraries
{
  std::string own;                  ///< path of that with FMI's functions
  std::vector<std::string> others;  ///< paths of what it loads and a system may lack
};

/// A co-simulation unit of this drive, as the bytes of its file. Files that parameters name go into the unit. @throws
/// InputError.
std::string driveFmu(const Parameters& parameters, const UnitLibraries& libraries, Version version);

/// The same of an arm with these drives under its controller. @throws InputError.
std::string armFmu(const std::string& name, const ArmDescription& arm, const std::vector<Parameters>& drives,
                   const UnitLibraries& libraries, Version version);
}  // namespace hjt::fmu
