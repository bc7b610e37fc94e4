// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "python/bindings.hpp"

namespace hjt
{
/// Adds a vector of a class as an array that is a view of it.
template <class Class, class Values>
void addArray(Class& type, const char* name, std::vector<double> Values::*values, const char* meaning)
{
  type.def_property_readonly(
      name, [values](const py::object& self) { return viewOf(self.cast<const Values&>().*values, self); }, meaning);
}

/// By its name. @throws InputError.
std::size_t stressPlace(const std::string& name);
}  // namespace hjt
