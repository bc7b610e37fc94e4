// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// The shipped configuration, overlays ("thesis_insertion", "joints/elbow") and `section.key=value` over it.
inline Parameters shippedParameters(const std::vector<std::string>& assignments = {},
                                    const std::vector<std::string>& overlays = {})
{
  ParameterMap map;
  readDefaultConfiguration(HJT_TEST_CONFIG_DIR, map);
  for (const std::string& overlay : overlays)
  {
    readYamlFile(HJT_TEST_CONFIG_DIR "/" + overlay + ".yaml", map);
  }
  for (const std::string& assignment : assignments)
  {
    readAssignment(assignment, map);
  }
  return parseParameters(map);
}

/// The cup as the golden numbers of the working drive have it: with the catalogue's stiffness of the whole gear.
constexpr const char* WHOLE_GEAR_CUP = "cup.torsion_stiffness=[31.0e+3, 50.0e+3, 57.0e+3]";

/// The gear as the thesis computes it, which the golden numbers are of; overlays over it.
inline Parameters goldenParameters(const std::vector<std::string>& assignments = {},
                                   std::vector<std::string> overlays = {})
{
  overlays.insert(overlays.begin(), "golden");
  return shippedParameters(assignments, overlays);
}

/// The laws of the thesis' insertion; its contact law unless another is given.
inline Parameters thesisParameters(const std::vector<std::string>& assignments = {})
{
  return shippedParameters(assignments, { "thesis_insertion" });
}
}  // namespace hjt
