// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// An argument that counts something. @throws InputError.
inline void requireAtLeast(const char* name, int value, int least)
{
  if (value < least)
  {
    throw InputError(std::string(name) + " = " + std::to_string(value) +
                     " [-] is out of range, allowed: >= " + std::to_string(least));
  }
}
}  // namespace hjt
