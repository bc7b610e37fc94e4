// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Statics are solved to rounding, whatever the running twin is content with.
inline SolverParameters staticSolver(SolverParameters parameters)
{
  constexpr double STATIC_TOLERANCE = 5e-7;  // N; the tension stiffness times the rounding of a coordinate is 2e-8 N
  parameters.force_tolerance = std::min(parameters.force_tolerance, STATIC_TOLERANCE);
  return parameters;
}
}  // namespace hjt
