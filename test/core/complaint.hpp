// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// What the ParameterError says that `call` ends in; empty if it ends in none.
template <class Call>
std::string complaintOf(const Call& call)
{
  try
  {
    call();
  }
  catch (const ParameterError& error)
  {
    return error.what();
  }
  return "";
}
}  // namespace hjt
