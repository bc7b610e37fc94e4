// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Unilateral contact per unit stiffness: energy, force and tangent over the depth.
///
/// width = 0, the exact law:  force = <depth>+
/// width > 0, a C1 ramp:      force = depth^2 / (2 width)  for depth < width,  depth - width/2  beyond
struct ContactRamp
{
  double energy{};   ///< [m^2]
  double force{};    ///< [m]
  double tangent{};  ///< [-]

  ContactRamp(double depth, double width) noexcept
  {
    // Both branches are computed and one is taken: loops over the teeth then vectorise.
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
}  // namespace hjt
