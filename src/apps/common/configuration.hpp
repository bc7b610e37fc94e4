// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/common/command.hpp"
#include "messages/topics.hpp"

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// What every subcommand of the tool takes.
struct CommonOptions
{
  std::string config_dir;            ///< where the default configuration lies; empty: found by itself
  std::vector<std::string> configs;  ///< overlays, later wins
  std::vector<std::string> assignments;
  std::vector<std::string> faults;  ///< KIND:SEVERITY[:PLACE[:ONSET]], beside the configured ones
  bool json{};
  bool force{};
};

/// `--fault`, for the commands that march the joint.
void addFaultOption(Command& command, CommonOptions& options);

/// Those about the configuration alone.
void addConfigurationOptions(Command& command, CommonOptions& options);

void addCommonOptions(Command& command, CommonOptions& options);

void addNamespaceOption(Command& command, std::string& joint_namespace);

/// Where the default configuration lies. @throws ParameterError if there is none.
std::filesystem::path configDirectory(const CommonOptions& options);

/// Steps of loadParameterMap: the default configuration, one overlay as given or beside it, those of the options.
/// @throws ParameterError.
ParameterMap defaultParameterMap(const CommonOptions& options);
void readOverlay(const CommonOptions& options, const std::string& name, ParameterMap& map);
void addOverlays(const CommonOptions& options, ParameterMap& map);

/// The default configuration with the overlays and assignments over it. @throws ParameterError.
ParameterMap loadParameterMap(const CommonOptions& options);

/// Adds the faults of `--fault` to the configured ones. @throws ParameterError.
void addFaults(const CommonOptions& options, Parameters& parameters);

/// The same, checked, with the faults of `--fault`. @throws ParameterError.
Parameters loadParameters(const CommonOptions& options);

/// A warning on stderr for each value of the gear that does not go with the others.
void printGearWarnings(const Parameters& parameters);

/// The parameters, with those warnings. @throws ParameterError.
Parameters loadGear(const CommonOptions& options);
}  // namespace hjt
