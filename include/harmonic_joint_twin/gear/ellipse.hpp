// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace hjt
{
/// Foot of the normal from a point to an ellipse, in the ellipse's own axes.
struct EllipseFoot
{
  double normal_x;   ///< outward unit normal at the foot [-]
  double normal_y;
  double depth;      ///< distance of the point inside the ellipse along the normal; < 0 outside [m]
  double curvature;  ///< of the ellipse at the foot [1/m]
};

/// Closest point of the ellipse with semi-axes a, b to a point (x, y) near it (thesis eq. 5.8, solved instead of
/// approximated): Newton on the eccentric angle, kept as a unit vector so that no trigonometry is needed.
/// The start is off by the relative depth times the eccentricity; two steps reach rounding on a real wave generator.
inline EllipseFoot closestPoint(double a, double b, double x, double y) noexcept
{
  constexpr int MAX_STEPS = 8;
  constexpr double ENOUGH = 1e-9;  // the next step's error is its square
  double c = x * b;
  double s = y * a;
  double scale = 1.0 / std::sqrt(c * c + s * s);
  c *= scale;
  s *= scale;
  const double focal = a * a - b * b;
  for (int i = 0; i < MAX_STEPS; ++i)
  {
    const double slope = focal * c * s - x * a * s + y * b * c;
    const double bend = focal * (c * c - s * s) - x * a * c - y * b * s;
    const double step = -slope / bend;
    const double cn = c - step * s;
    const double sn = s + step * c;
    scale = 1.0 / std::sqrt(cn * cn + sn * sn);
    c = cn * scale;
    s = sn * scale;
    if (std::abs(step) < ENOUGH)
    {
      break;
    }
  }
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
}  // namespace hjt
