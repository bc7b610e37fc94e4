// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt
{
/// Number of solver steps between two rows or messages, at least 1. Both rates are in [Hz].
inline long long publishSteps(double publish_rate, double solver_rate)
{
  return std::max(std::llround(solver_rate / publish_rate), 1LL);
}

/// Time between two messages of a topic, or between two rows [ns].
inline Stamp publishPeriod(double publish_rate, double solver_rate)
{
  return publishSteps(publish_rate, solver_rate) * std::llround(1e9 / solver_rate);
}
}  // namespace hjt
