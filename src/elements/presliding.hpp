// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace hjt
{
/// Share of a dry friction from which on what it holds is taken to slide [-].
constexpr double SLIDING_SHARE = 0.95;

/// Share of a dry friction that is mobilised, between -1 and 1, after a further turn (Dahl, exact):
///
///   ds/dx = (1 - s sgn(dx)) / angle
/// `turn` dx and `angle` in rad, angle > 0.
inline double mobilised(double share, double turn, double angle) noexcept
{
  const double end = std::copysign(1.0, turn);
  return end + (share - end) * std::exp(-std::abs(turn) / angle);
}
}  // namespace hjt
