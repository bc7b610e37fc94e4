// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/gear/ring_shape.hpp"

namespace hjt
{
void RingShape::updateGeometry() noexcept
{
  const int n = teeth();
  const double* p = points.data();
  double* direction = directions.data();
  for (int i = 0; i < n; ++i)
  {
    const int j = next(i);
    const double dx = p[2 * j] - p[2 * i];
    const double dy = p[2 * j + 1] - p[2 * i + 1];
    const double length = std::sqrt(dx * dx + dy * dy);
    const double inverse = 1.0 / length;
    lengths[i] = length;
    direction[2 * i] = dx * inverse;
    direction[2 * i + 1] = dy * inverse;
  }
}
}  // namespace hjt
