// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/gear/ring_shape.hpp"

#include <cmath>

namespace hjt
{
void RingShape::updateGeometry() noexcept
{
  const int n = teeth();
  const double* p = points.data();
  double* direction = directions.data();
  double* normal = normals.data();
  for (int i = 0; i < n; ++i)
  {
    const int j = next(i);
    const double dx = p[2 * j] - p[2 * i];
    const double dy = p[2 * j + 1] - p[2 * i + 1];
    const double length = std::sqrt(dx * dx + dy * dy);
    lengths[i] = length;
    direction[2 * i] = dx / length;
    direction[2 * i + 1] = dy / length;
  }
  for (int i = 0; i < n; ++i)
  {
    const int j = next(i);
    const int h = previous(i);
    const double dx = p[2 * j] - p[2 * h];
    const double dy = p[2 * j + 1] - p[2 * h + 1];
    const double chord = std::sqrt(dx * dx + dy * dy);
    chords[i] = chord;
    normal[2 * i] = dy / chord;
    normal[2 * i + 1] = -dx / chord;
  }
}
}  // namespace hjt
