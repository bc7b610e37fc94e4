// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "python/bindings.hpp"

namespace hjt
{
constexpr const char* ORIGIN = "Python";  ///< of values, for error texts

/// Puts keys and values into the map, unchecked. @throws ParameterError where one is no value.
void put(const py::dict& values, ParameterMap& map);

/// Reads one overlay, a file as given or beside `directory`, or a dict, over the map, unchecked.
/// @throws ParameterError, Python's TypeError.
void readOverlay(const py::handle& what, const std::string& directory, ParameterMap& map);
}  // namespace hjt
