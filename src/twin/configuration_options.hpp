// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "twin/option_table.hpp"

namespace hjt
{
/// Which parameters are asked for: the default configuration and what lies over it.
struct ConfigurationOptions
{
  std::string config_dir;                ///< where the default configuration lies; empty: found by itself
  std::vector<std::string> configs;      ///< overlays, files; later wins
  std::vector<std::string> assignments;  ///< section.key=value, over the overlays
  std::vector<std::string> faults;       ///< KIND:SEVERITY[:PLACE[:ONSET]], beside the configured ones
  ParameterMap values;                   ///< over all of these

  /// Nothing lies over the default configuration but faults.
  bool isDefault() const { return configs.empty() && assignments.empty() && values.empty(); }
};

constexpr const char* COMMON_GROUP = "Common options";

/// Its files and assignments; Python has `overlays` in their place.
void addOptions(OptionTable& table, ConfigurationOptions& options);
/// The same, and whether files are overwritten.
void addOptions(OptionTable& table, ConfigurationOptions& options, bool& force);

/// `--fault`, for what marches or analyses the joint.
void addFaultOption(OptionTable& table, ConfigurationOptions& options);

/// Folder of the default configuration. @throws ParameterError if there is none.
std::filesystem::path configDirectory(const ConfigurationOptions& options);

/// Steps of loadParameterMap: the default configuration, one overlay as given or beside it, those of the options.
/// @throws ParameterError.
ParameterMap defaultParameterMap(const ConfigurationOptions& options);
void readOverlay(const ConfigurationOptions& options, const std::string& name, ParameterMap& map);
void addOverlays(const ConfigurationOptions& options, ParameterMap& map);

/// The default configuration with the overlays, assignments and values over it. @throws ParameterError.
ParameterMap loadParameterMap(const ConfigurationOptions& options);

/// Adds the faults of the options to the configured ones. @throws ParameterError.
void addFaults(const ConfigurationOptions& options, Parameters& parameters);

/// The same, checked, with the faults. @throws ParameterError.
Parameters loadParameters(const ConfigurationOptions& options);
}  // namespace hjt
