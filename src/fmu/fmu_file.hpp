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
  std::vector<std::string> others;  ///< paths of the libraries that `own` loads and that a system may lack
};

/// Content of the file of a co-simulation unit for a drive, with the files that `parameters` name. @throws
/// InputError.
std::string driveFmu(const Parameters& parameters, const UnitLibraries& libraries, Version version);

/// Content of the file of a co-simulation unit for an arm with its drives and controller. @throws InputError.
std::string armFmu(const std::string& name, const ArmDescription& arm, const std::vector<Parameters>& drives,
                   const UnitLibraries& libraries, Version version);
}  // namespace hjt::fmu
