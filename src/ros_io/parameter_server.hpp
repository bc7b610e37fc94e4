// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Reads every parameter below `parameter_namespace` (`section/key`) from the parameter server; types are kept as they
/// are. Nothing is left out, so that `parseParameters` finds unknown keys; nothing is defaulted.
/// @throws ParameterError on a value that no parameter can have, e.g. a list with a text in it.
ParameterMap readParameterServer(const std::string& parameter_namespace);
}  // namespace hjt
