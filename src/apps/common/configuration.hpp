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

/// A warning on stderr for each value of the gear that does not go with the others.
void printGearWarnings(const Parameters& parameters);

/// The parameters, with those warnings. @throws ParameterError.
Parameters loadGear(const ConfigurationOptions& options);

/// The same for an analysis, with the faults that it honours. @throws ParameterError if one cannot act in it.
Parameters loadAnalysed(const ConfigurationOptions& options, Analysis analysis);

/// Reports that no equilibrium was found for `what`, and why. @returns the exit code.
int notConverged(const std::string& what, const SolveStatus& status);
}  // namespace hjt
