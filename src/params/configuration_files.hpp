// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Directory of the shared library that contains this function.
std::filesystem::path libraryDirectory();

/// Directory that contains config/ and scripts/: the installed directory, or the sources in a development space.
/// @throws ParameterError if the program is neither in an installation nor in a development space.
std::filesystem::path packageDirectory();

/// Directory of the default configuration: the first that is set of `given`, HJT_CONFIG_DIR, packageDirectory/config.
/// @throws ParameterError if the directory has no default configuration.
std::filesystem::path configurationDirectory(const std::string& given);

/// Path of the configuration file `name`: `name` itself or, if no such file exists, its path in the default
/// configuration in `directory`. `config/x.yaml` and `joints/x.yaml` therefore work in any working directory.
std::string findConfiguration(const std::string& name, const std::filesystem::path& directory);

/// Copies `values` into `map`, where they replace the values of equal keys.
void putOver(const ParameterMap& values, ParameterMap& map);

/// Replaces the value of indicators.signatures in `map` by the path that findConfiguration finds in `directory`.
void findNamedFiles(const std::filesystem::path& directory, ParameterMap& map);
}  // namespace hjt
