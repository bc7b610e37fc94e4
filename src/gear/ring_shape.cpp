// SPDX-License-Identifier: BSD-3-Clause
#include "gear/ring_shape.hpp"

#include "gear/vector_loops.hpp"

namespace hjt
{
HJT_VECTOR_CLONES void RingShape::updateGeometry() noexcept
{
  if (copies() > 1)
  {
    repeatHalfTurned(points);
  }
  const int last = solved - 1;
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
  update(last, next(last));
  if (copies() > 1)
  {
    repeatHalfTurned(directions);
    repeatHalf(lengths);
  }
}

HJT_VECTOR_CLONES void RingShape::repeatSpaces(int spaces) noexcept
{
  const int half = spaces / 2;
  const int others = teeth() - solved;
  const int* __restrict__ from = space.data();
  int* __restrict__ to = space.data() + solved;
#pragma omp simd
  for (int i = 0; i < others; ++i)
  {
    const int opposite = from[i] + half;
    to[i] = opposite < spaces ? opposite : opposite - spaces;
  }
}
}  // namespace hjt
