// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// Message of the InputError or ParameterError that `call` throws; empty: it throws none.
template <class Call>
std::string complaintOf(const Call& call)
{
  try
  {
    call();
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return "";
}
}  // namespace hjt
