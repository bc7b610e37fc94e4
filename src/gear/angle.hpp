// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace hjt
{
constexpr double PI = 3.14159265358979323846;
constexpr double TWO_PI = 2.0 * PI;
constexpr double DEGREE = PI / 180.0;

/// Tangent up to which the series of `smallAngle` is good to full double precision.
constexpr double SMALL_TANGENT = 0.02;

/// Angle whose tangent is `t`, at most SMALL_TANGENT [rad].
inline double smallAngle(double t) noexcept
{
  const double t2 = t * t;
  return t * (1.0 - t2 * (1.0 / 3.0 - t2 * (1.0 / 5.0 - t2 * (1.0 / 7.0 - t2 * (1.0 / 9.0)))));
}

/// Angle of a vector given by its components along (`along`) and across (`across`) a reference direction [rad].
/// The angles of a ring are small; a series to full double precision is several times faster than atan2.
inline double smallAngle(double across, double along) noexcept
{
  return std::abs(across) < SMALL_TANGENT * along ? smallAngle(across / along) : std::atan2(across, along);
}
}  // namespace hjt
