// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Folder of the library that this function is in.
std::filesystem::path libraryDirectory();

/// Folder with config/ and scripts/: in the installation, or in the sources of a development space.
/// @throws ParameterError if the program lies in neither.
std::filesystem::path packageDirectory();

/// The directory of the default configuration: as given, else HJT_CONFIG_DIR, else of the package.
/// @throws ParameterError if there is none.
std::filesystem::path configurationDirectory(const std::string& given);

/// A configuration file as given, else beside the default configuration: `config/x.yaml` and `joints/x.yaml` work from
/// anywhere.
std::string findConfiguration(const std::string& name, const std::filesystem::path& directory);

/// Puts the values over those of `map`.
void putOver(const ParameterMap& values, ParameterMap& map);

/// Where the default configuration is another than this process finds by itself: files that parameters name are looked
/// for beside it too.
void findNamedFiles(const std::filesystem::path& directory, ParameterMap& map);
}  // namespace hjt
