// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace hjt
{
/// Foot of the normal from a point to an ellipse, in the axes of the ellipse.
struct EllipseFoot
{
  double normal_x;  ///< outward unit normal at the foot [-]
  double normal_y;
  double depth;      ///< distance of the point inside the ellipse along the normal; < 0 outside [m]
  double curvature;  ///< curvature of the ellipse at the foot [1/m]
};

/// Foot for the point (x, y) [m]. `a`, `b`: semi-axes [m]; `c`, `s`: cosine and sine of the foot's eccentric angle.
inline EllipseFoot footAt(double a, double b, double x, double y, double c, double s) noexcept
{
  const double nx = b * c;
  const double ny = a * s;
  const double inverse = 1.0 / std::sqrt(nx * nx + ny * ny);
  EllipseFoot foot;
  foot.normal_x = nx * inverse;
  foot.normal_y = ny * inverse;
  foot.depth = (a * c - x) * foot.normal_x + (b * s - y) * foot.normal_y;
  foot.curvature = a * b * inverse * inverse * inverse;
  return foot;
}

/// Newton step of the eccentric angle, with the cosine `c` and the sine `s`, towards the closest point [rad].
inline double closestPointStep(double a, double b, double x, double y, double c, double s) noexcept
{
  const double focal = a * a - b * b;
  const double slope = focal * c * s - x * a * s + y * b * c;
  const double bend = focal * (c * c - s * s) - x * a * c - y * b * s;
  return -slope / bend;
}

/// Whether the distance of a point from the ellipse is less than 2 % of the semi-axes, as closestPointNear requires.
inline bool isNear(double a, double b, double x, double y) noexcept
{
  constexpr double NEAR_POINT = 0.04;
  const double c = x * (1.0 / a);
  const double s = y * (1.0 / b);
  return std::abs(c * c + s * s - 1.0) < NEAR_POINT;
}

/// Point of the ellipse with the semi-axes a and b that is closest to a nearby point (x, y). Newton's method on the
/// eccentric angle solves thesis eq. 5.8, which the thesis approximates. The angle is stored as a unit vector.
///
/// The first guess has an error of depth / radius times squared eccentricity, about 1e-5 rad for a real wave generator.
/// A Newton step of size e leaves an error of 0.02 e^2, so that one step reaches 1e-10 rad. The code has no branches
/// and few divisions, so that the compiler vectorises it.
inline EllipseFoot closestPointNear(double a, double b, double x, double y) noexcept
{
  const double c0 = x * (1.0 / a);
  const double s0 = y * (1.0 / b);
  // The length of (c0, s0) is sqrt(1 + q). The series for 1 / length has an error of q^4 / 4.
  const double q = c0 * c0 + s0 * s0 - 1.0;
  const double inverse = 1.0 - q * (0.5 - q * (0.375 - q * 0.3125));
  const double c = c0 * inverse;
  const double s = s0 * inverse;
  const double step = closestPointStep(a, b, x, y, c, s);
  const double scale = 1.0 - 0.5 * step * step;
  return footAt(a, b, x, y, scale * (c - step * s), scale * (s + step * c));
}

/// Point of the ellipse that is closest to a point (x, y), which must not be the centre.
inline EllipseFoot closestPoint(double a, double b, double x, double y) noexcept
{
  constexpr int MAX_STEPS = 30;
  constexpr double ENOUGH = 1e-8;
  const double start = 1.0 / std::sqrt(x * b * x * b + y * a * y * a);
  double c = x * b * start;
  double s = y * a * start;
  double step = 1.0;
  for (int i = 0; i < MAX_STEPS && std::abs(step) > ENOUGH; ++i)
  {
    step = closestPointStep(a, b, x, y, c, s);
    const double scale = 1.0 / std::sqrt(1.0 + step * step);
    const double turned = scale * (c - step * s);
    s = scale * (s + step * c);
    c = turned;
  }
  return footAt(a, b, x, y, c, s);
}
}  // namespace hjt
