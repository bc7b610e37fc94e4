// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace hjt
{
constexpr double PI = 3.14159265358979323846;
constexpr double TWO_PI = 2.0 * PI;

/// Angle of a vector given by its components along (`along`) and across (`across`) a reference direction [rad].
/// The angles of a ring are small; a series to full double precision is several times faster than atan2.
inline double smallAngle(double across, double along) noexcept
{
  if (!(std::abs(across) < 0.02 * along))
  {
    return std::atan2(across, along);
  }
  const double t = across / along;
  const double t2 = t * t;
  return t * (1.0 - t2 * (1.0 / 3.0 - t2 * (1.0 / 5.0 - t2 * (1.0 / 7.0 - t2 / 9.0))));
}
}  // namespace hjt
