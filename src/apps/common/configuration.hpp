// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/common/command.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "statics/gear_rules.hpp"

#include "twin/options.hpp"

namespace hjt
{
/// Options of every subcommand of the tool.
struct CommonOptions : ConfigurationOptions
{
  bool json{};
  bool force{};
};

void addJsonOption(OptionTable& table, bool& json);
void addCommonOptions(OptionTable& table, CommonOptions& options);

/// Prints a warning on stderr for each parameter of the gear that is inconsistent with other parameters of the gear.
void printGearWarnings(const Parameters& parameters);

/// Loads the parameters and prints the warnings of `printGearWarnings`. @throws ParameterError.
Parameters loadGear(const ConfigurationOptions& options);

/// Loads the parameters for an analysis. @throws ParameterError if a configured fault has no effect in this analysis.
Parameters loadAnalysed(const ConfigurationOptions& options, Analysis analysis);

/// Prints that the solver found no equilibrium for `what`, and the reason. @returns the exit code of the program.
int notConverged(const std::string& what, const SolveStatus& status);
}  // namespace hjt
