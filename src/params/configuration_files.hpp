// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Directory of the shared library that contains this function.
std::filesystem::path libraryDirectory();

/// Directory with config/ and scripts/: that of the installation, or that of the sources in a development space.
/// @throws ParameterError if the program is in neither of these two.
std::filesystem::path packageDirectory();

/// Directory of the default configuration: `given` or, if empty, HJT_CONFIG_DIR or, if empty, that in packageDirectory.
/// @throws ParameterError if this directory has no default configuration.
std::filesystem::path configurationDirectory(const std::string& given);

/// Finds a configuration file by its path as given or, if there is no such file, relative to the default configuration.
/// `config/x.yaml` and `joints/x.yaml` therefore work in any working directory.
std::string findConfiguration(const std::string& name, const std::filesystem::path& directory);

/// Adds `values` to `map`. They replace values of equal keys.
void putOver(const ParameterMap& values, ParameterMap& map);

/// Completes the path of indicators.signatures, relative to the default configuration in `directory`.
void findNamedFiles(const std::filesystem::path& directory, ParameterMap& map);
}  // namespace hjt
