// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt
{
/// Of the solver's steps from one row or message to the next, at least 1; both rates in Hz.
inline long long publishSteps(double publish_rate, double solver_rate)
{
  return std::max(std::llround(solver_rate / publish_rate), 1LL);
}

/// Between two messages of a topic, or two rows [ns].
inline Stamp publishPeriod(double publish_rate, double solver_rate)
{
  return publishSteps(publish_rate, solver_rate) * std::llround(1e9 / solver_rate);
}
}  // namespace hjt
