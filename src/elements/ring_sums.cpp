// SPDX-License-Identifier: BSD-3-Clause
#include "elements/ring_sums.hpp"

#include "gear/vector_loops.hpp"

namespace hjt
{
HJT_VECTOR_CLONES void RingTangent::addSegments(int solved) noexcept
{
  const int n = solved;
  const double* __restrict__ s_xx = segment.xx.data();
  const double* __restrict__ s_xy = segment.xy.data();
  const double* __restrict__ s_yy = segment.yy.data();
  double* __restrict__ d_xx = diagonal.xx.data();
  double* __restrict__ d_xy = diagonal.xy.data();
  double* __restrict__ d_yy = diagonal.yy.data();
  double* __restrict__ n_xx = next.xx.data();
  double* __restrict__ n_xy = next.xy.data();
  double* __restrict__ n_yx = next.yx.data();
  double* __restrict__ n_yy = next.yy.data();
  const auto add = [&](int h, int i)
  {
    d_xx[i] += s_xx[h] + s_xx[i];
    d_xy[i] += s_xy[h] + s_xy[i];
    d_yy[i] += s_yy[h] + s_yy[i];
    n_xx[i] -= s_xx[i];
    n_xy[i] -= s_xy[i];
    n_yx[i] -= s_xy[i];
    n_yy[i] -= s_yy[i];
  };
  add(n - 1, 0);
#pragma omp simd
  for (int i = 1; i < n; ++i)
  {
    add(i - 1, i);
  }
}

void RingTangent::closeHalf() noexcept
{
  const int half = teeth() / 2;
  const int last = half - 1;
  // The neighbours of the half ring have entries too. The entries of tooth `half` are added to tooth 0, and those of
  // the last tooth of the ring to the last tooth of the half.
  const int beyond = teeth() - 1;
  for (Eigen::VectorXd* entry : { &diagonal.xx, &diagonal.xy, &diagonal.yy })
  {
    (*entry)[0] += (*entry)[half];
    (*entry)[last] += (*entry)[beyond];
  }
  for (Eigen::VectorXd* entry : { &next.xx, &next.xy, &next.yx, &next.yy })
  {
    (*entry)[last] = -((*entry)[last] + (*entry)[beyond]);
  }
  for (Eigen::VectorXd* entry : { &second.xx, &second.xy, &second.yx, &second.yy })
  {
    (*entry)[last] = -((*entry)[last] + (*entry)[beyond]);
    (*entry)[last - 1] = -(*entry)[last - 1];
  }
  for (Eigen::VectorXd* mixed : { &wave_generator, &output })
  {
    mixed->head<2>() -= mixed->segment<2>(2 * half);
    mixed->segment<2>(2 * last) -= mixed->tail<2>();
  }
  cup_stiffness *= 2.0;
  wave_generator_stiffness *= 2.0;
  output_stiffness *= 2.0;
}
}  // namespace hjt
