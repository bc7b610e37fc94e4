// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/common/command.hpp"
#include "statics/analysed_faults.hpp"

#include "twin/configuration_options.hpp"

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
}  // namespace hjt
