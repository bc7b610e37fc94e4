// SPDX-License-Identifier: BSD-3-Clause
#include "gear/ring_shape.hpp"

#include "gear/vector_clones.hpp"

namespace hjt
{
HJT_VECTOR_CLONES void RingShape::updateGeometry() noexcept
{
  const int last = teeth() - 1;
  const double* __restrict__ p = points.data();
  double* __restrict__ direction = directions.data();
  double* __restrict__ length = lengths.data();
  const auto update = [&](int i, int j)
  {
    const double dx = p[2 * j] - p[2 * i];
    const double dy = p[2 * j + 1] - p[2 * i + 1];
    const double distance = std::sqrt(dx * dx + dy * dy);
    const double inverse = 1.0 / distance;
    length[i] = distance;
    direction[2 * i] = dx * inverse;
    direction[2 * i + 1] = dy * inverse;
  };
#pragma omp simd
  for (int i = 0; i < last; ++i)
  {
    update(i, i + 1);
  }
  update(last, 0);
}
}  // namespace hjt
