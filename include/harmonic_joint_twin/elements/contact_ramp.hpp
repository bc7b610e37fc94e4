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
    if (depth <= 0.0)
    {
      return;
    }
    if (depth >= width)
    {
      force = depth - 0.5 * width;
      energy = 0.5 * force * force + width * width / 24.0;
      tangent = 1.0;
    }
    else
    {
      force = 0.5 * depth * depth / width;
      energy = depth * depth * depth / (6.0 * width);
      tangent = depth / width;
    }
  }
};
}  // namespace hjt
