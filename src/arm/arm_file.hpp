// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// The text of a file of at most MAX_TEXT bytes (base/whole_file.hpp). `place`: where it is named, for the error text.
/// @throws ParameterError if it is no regular file, larger, empty, or cannot be read.
std::string textOf(const std::string& path, const std::string& place = "");

/// `name` in the folder of the file `path`; `name` if it is absolute.
std::string beside(const std::string& path, const std::string& name);

/// Contents of an arm's YAML file, under keys joined by dots: "payload.mass", "joints.0.name". A list of numbers is one
/// value; elements of another have keys of their own. Keys that the file does not give are those of the file that it is
/// `like`, and so on; "description" is beside the file that gives it.
/// @throws ParameterError naming file and line.
ParameterMap readArmFile(const std::string& path);
}  // namespace hjt
