// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Parameters of an arm's node beside those of its drives: name or file of the arm; directory of overlays that
/// `joint_twin identify --arm` wrote; name of the parameter that holds another URDF of it.
constexpr const char* ARM = "arm";
constexpr const char* IDENTIFIED = "identified";
constexpr const char* DESCRIPTION = "description";

/// Reads every other parameter below `parameter_namespace` (`section/key`) from the server; types are kept as they
/// are. Nothing is left out, so that `parseParameters` finds unknown keys; nothing is defaulted.
/// @throws ParameterError on a value that no parameter can have, e.g. a list with a text in it.
ParameterMap readParameterServer(const std::string& parameter_namespace);

/// Puts all parameters below `parameter_namespace`, in place of what is there.
void writeParameterServer(const std::string& parameter_namespace, const ParameterMap& map);
}  // namespace hjt
