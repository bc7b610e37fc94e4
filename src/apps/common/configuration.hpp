// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/common/command.hpp"
#include "messages/topics.hpp"

#include "twin/configuration_options.hpp"

namespace hjt
{
/// What every subcommand of the tool takes.
struct CommonOptions : ConfigurationOptions
{
  bool json{};
  bool force{};
};

/// `--fault`, for the commands that march the joint.
void addFaultOption(Command& command, ConfigurationOptions& options);

/// Options about the configuration alone.
void addConfigurationOptions(Command& command, ConfigurationOptions& options);

void addCommonOptions(Command& command, CommonOptions& options);
void addCommonOptions(Command& command, ConfigurationOptions& options, bool& json, bool& force);

void addNamespaceOption(Command& command, std::string& joint_namespace);

/// A warning on stderr for each value of the gear that does not go with the others.
void printGearWarnings(const Parameters& parameters);

/// The parameters, with those warnings. @throws ParameterError.
Parameters loadGear(const ConfigurationOptions& options);
}  // namespace hjt
