// SPDX-License-Identifier: BSD-3-Clause
#include "elements/rim_tension.hpp"

#include "gear/block_sums.hpp"
#include "gear/vector_clones.hpp"

namespace hjt
{
RimTension::RimTension(const Parameters& parameters, const ToothRing& rest)
  : stiffness_(Eigen::VectorXd::Constant(rest.teeth(), parameters.ring.tension_stiffness))
  , rest_length_(rest.segmentLength())
{
}

HJT_VECTOR_CLONES void RimTension::addForces(const RingShape& shape, const DrivePosition&, Scratch&,
                                             ForceSum& sum) const noexcept
{
  const int n = shape.solved;
  const double* __restrict__ length = shape.lengths.data();
  const double* __restrict__ direction = shape.directions.data();
  const double* __restrict__ stiffness = stiffness_.data();
  double* __restrict__ segment = sum.segment.data();
  const double rest = rest_length_;
  const auto pull_segment = [&](int i)
  {
    const double stretch = length[i] - rest;
    const double pull = stiffness[i] * stretch;
    segment[2 * i] = pull * direction[2 * i];
    segment[2 * i + 1] = pull * direction[2 * i + 1];
    return 0.5 * pull * stretch;
  };
  sum.energy += blockSum(0, n, pull_segment);
  sum.addSegmentForces(n);
}

HJT_VECTOR_CLONES void RimTension::addTangent(const RingShape& shape, const Scratch&,
                                              RingTangent& tangent) const noexcept
{
  const int n = shape.solved;
  const double* __restrict__ length = shape.lengths.data();
  const double* __restrict__ direction = shape.directions.data();
  const double* __restrict__ stiffness = stiffness_.data();
  double* __restrict__ xx = tangent.segment.xx.data();
  double* __restrict__ xy = tangent.segment.xy.data();
  double* __restrict__ yy = tangent.segment.yy.data();
  const double rest = rest_length_;
#pragma omp simd
  for (int i = 0; i < n; ++i)
  {
    // k u u^T along the segment, tension / length across it.
    const double across = stiffness[i] * (length[i] - rest) / length[i];
    const double x = direction[2 * i];
    const double y = direction[2 * i + 1];
    const double along = stiffness[i] - across;
    xx[i] = across + along * x * x;
    xy[i] = along * x * y;
    yy[i] = across + along * y * y;
  }
  tangent.addSegments(n);
}
}  // namespace hjt
