// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "harmonic_joint_twin/health/fault_signatures.hpp"

namespace hjt
{
constexpr double OTHER_MOTION = 1e-3;  // weight of a signature of no motion alike

/// How far a signature's motion and the window's are alike, 0 ... 1.
inline double likeness(const MotionKind& motion, const OperatingPoint& point) noexcept
{
  constexpr double SPEED_RANGE = 0.2;      // of the logarithm, in which motions are alike
  constexpr double DIRECTION_RANGE = 0.3;  // as well
  if (!(motion.speed > 0.0 && point.speed > 0.0))
  {
    return 1.0;
  }
  const double speed = std::log(point.speed / motion.speed) / SPEED_RANGE;
  const double direction = (std::abs(point.direction) - motion.direction) / DIRECTION_RANGE;
  return std::exp(-0.5 * (speed * speed + direction * direction));
}
}  // namespace hjt
