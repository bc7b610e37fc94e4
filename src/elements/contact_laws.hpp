// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace hjt
{
/// Unilateral contact of unit stiffness: energy, force and tangent as functions of the depth of penetration.
///
/// width = 0, the exact law:  force = max(depth, 0)
/// width > 0, a C1 ramp:      force = depth^2 / (2 width)  for 0 < depth < width,  depth - width/2  for larger depths
struct ContactRamp
{
  double energy{};   ///< energy over stiffness [m^2]
  double force{};    ///< force over stiffness [m]
  double tangent{};  ///< derivative of `force` by the depth [-]

  ContactRamp(double depth, double width) noexcept
  {
    // Both branches of the law are computed before one is selected, so that the loops over the teeth vectorise.
    const double part = depth / width;
    const double full_force = depth - 0.5 * width;
    const double full_energy = 0.5 * full_force * full_force + width * width / 24.0;
    const double part_force = 0.5 * depth * part;
    const double part_energy = depth * depth * part / 6.0;
    const bool touching = depth > 0.0;
    const bool full = depth >= width;
    force = touching ? (full ? full_force : part_force) : 0.0;
    energy = touching ? (full ? full_energy : part_energy) : 0.0;
    tangent = touching ? (full ? 1.0 : part) : 0.0;
  }
};

/// Hertz' point contact of unit stiffness: energy, force and tangent as functions of the depth of penetration. At the
/// depth 0, where the contact opens, the tangent is 0.
struct HertzContact
{
  double energy{};   ///< energy over stiffness [m^2.5]
  double force{};    ///< force over stiffness [m^1.5]
  double tangent{};  ///< derivative of `force` by the depth [m^0.5]

  explicit HertzContact(double depth) noexcept
  {
    const double pressed = depth > 0.0 ? depth : 0.0;
    const double root = std::sqrt(pressed);
    force = pressed * root;
    energy = 0.4 * pressed * force;
    tangent = 1.5 * root;
  }
};

/// Stiffness K of a steel ball between two races [N/m^1.5]: Q = K depth^1.5, Q = force, depth = approach of the races.
/// Palmgren's formula for ball bearings with the usual osculation is depth = 4.36e-4 Q^(2/3) d^(-1/3) in mm and N,
/// where d is the diameter of the ball, here `ball_diameter` [m].
inline double hertzStiffness(double ball_diameter) noexcept
{
  constexpr double PALMGREN = 4.36e-4;                                         // mm^(4/3) / N^(2/3)
  constexpr double MILLIMETRES = 1e3;                                          // millimetres in a metre
  const double per_force = PALMGREN / std::cbrt(MILLIMETRES * ball_diameter);  // depth / Q^(2/3) [mm/N^(2/3)]
  const double depth_scale = MILLIMETRES / per_force;
  return depth_scale * std::sqrt(depth_scale);
}
}  // namespace hjt
