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

/// Prints a warning on stderr for each inconsistent value of the gear.
void printGearWarnings(const Parameters& parameters);

/// Loads the parameters and prints these warnings. @throws ParameterError.
Parameters loadGear(const ConfigurationOptions& options);

/// Loads the parameters for an analysis. @throws ParameterError if a fault cannot act in it.
Parameters loadAnalysed(const ConfigurationOptions& options, Analysis analysis);

/// Reports that there is no equilibrium for `what`, with the reason. @returns the exit code.
int notConverged(const std::string& what, const SolveStatus& status);
}  // namespace hjt
