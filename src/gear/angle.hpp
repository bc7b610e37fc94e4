// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace hjt
{
constexpr double PI = 3.14159265358979323846;
constexpr double TWO_PI = 2.0 * PI;
constexpr double DEGREE = PI / 180.0;

/// Largest tangent for which the series in `smallAngle` has full double precision [-].
constexpr double SMALL_TANGENT = 0.02;

/// Angle with the tangent `t`, whose magnitude is at most SMALL_TANGENT [rad].
inline double smallAngle(double t) noexcept
{
  const double t2 = t * t;
  return t * (1.0 - t2 * (1.0 / 3.0 - t2 * (1.0 / 5.0 - t2 * (1.0 / 7.0 - t2 * (1.0 / 9.0)))));
}

/// Angle of a vector with the components `along` and `across` a reference direction [rad]. The function uses a series
/// for small angles, which is several times faster than atan2 and has full double precision.
inline double smallAngle(double across, double along) noexcept
{
  return std::abs(across) < SMALL_TANGENT * along ? smallAngle(across / along) : std::atan2(across, along);
}
}  // namespace hjt
