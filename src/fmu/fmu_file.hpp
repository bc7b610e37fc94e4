// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "fmu/fmi.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt::fmu
{
struct UnitLibraries
{
  std::string own;                  ///< path of the library with FMI's functions
  std::vector<std::string> others;  ///< paths of the libraries that it loads and a system may lack
};

/// Bytes of the file of a co-simulation unit for this drive, with the files that its parameters name. @throws
/// InputError.
std::string driveFmu(const Parameters& parameters, const UnitLibraries& libraries, Version version);

/// Bytes of the file of a unit for an arm with these drives and its controller. @throws InputError.
std::string armFmu(const std::string& name, const ArmDescription& arm, const std::vector<Parameters>& drives,
                   const UnitLibraries& libraries, Version version);
}  // namespace hjt::fmu
