// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Directory of the library that contains this function.
std::filesystem::path libraryDirectory();

/// Directory with config/ and scripts/: that of the installation, or the sources of a development space.
/// @throws ParameterError if the program is in neither.
std::filesystem::path packageDirectory();

/// Directory of the default configuration: `given`, else HJT_CONFIG_DIR, else the package's.
/// @throws ParameterError if there is none.
std::filesystem::path configurationDirectory(const std::string& given);

/// Finds a configuration file: the path as given, else relative to the default configuration. `config/x.yaml` and
/// `joints/x.yaml` therefore work in any working directory.
std::string findConfiguration(const std::string& name, const std::filesystem::path& directory);

/// Replaces the values of `map` by `values`.
void putOver(const ParameterMap& values, ParameterMap& map);

/// Registers a default configuration that the process would not find itself, so that files named by parameters are
/// found beside it.
void findNamedFiles(const std::filesystem::path& directory, ParameterMap& map);
}  // namespace hjt
