// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "fmu/fmi.hpp"
#include "fmu/variables.hpp"

namespace hjt::fmu
{
/// What stands in a unit's description.
struct UnitDescription
{
  std::string name;
  std::string meaning;
  std::string library;  ///< in the unit, without its ending
  std::string token;    ///< see instantiationToken
  double rate{};        ///< of its own steps [Hz]
  double step{};        ///< of an importer, by default [s]
  std::vector<FmuVariable> variables;
};

/// The version's modelDescription.xml.
std::string modelDescription(const UnitDescription& unit, Version version);
}  // namespace hjt::fmu
