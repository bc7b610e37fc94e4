// SPDX-License-Identifier: BSD-3-Clause
#include "elements/rim_elasticity.hpp"

#include <cmath>

#include "gear/angle.hpp"
#include "gear/vector_loops.hpp"

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
    // Along the segment the stiffness is that of the spring. Across the segment the stiffness is tension / length.
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

RimBending::RimBending(const Parameters& parameters, const ToothRing& rest)
  : law_(parameters.ring.bending_law)
  , stiffness_(Eigen::VectorXd::Constant(rest.teeth(), parameters.ring.bending_stiffness))
  , race_(parameters.bearing.race_bending_stiffness)
  , natural_angle_(Eigen::VectorXd::Zero(rest.teeth()))
  , rest_directions_(rest.segments())
  , rest_cos_(std::cos(rest.pitchAngle()))
  , rest_sin_(std::sin(rest.pitchAngle()))
{
}

/// Adds the bending energy to `sum` and writes the moment at each tooth, stiffness times bending angle, to `scratch`.
HJT_VECTOR_CLONES void RimBending::addMoments(const RingShape& shape, Scratch& scratch, ForceSum& sum) const noexcept
{
  const int n = shape.solved;
  const double* __restrict__ direction = shape.directions.data();
  const double* __restrict__ stiffness = stiffness_.data();
  const double* __restrict__ natural_angle = natural_angle_.data();
  const double race = race_;
  double* reference = sum.segment.data();
  double* moment = scratch.moment.data();
  if (law_ == BendingLaw::ABSOLUTE)
  {
    sum.segment = rest_directions_;
  }
  else
  {
    // If the rim were bent as at rest, each segment would have the direction of the preceding one, turned by a pitch.
    const double c = rest_cos_;
    const double s = rest_sin_;
    const int before = 2 * shape.previous(0);
    reference[0] = c * direction[before] - s * direction[before + 1];
    reference[1] = s * direction[before] + c * direction[before + 1];
#pragma omp simd
    for (int i = 1; i < n; ++i)
    {
      reference[2 * i] = c * direction[2 * i - 2] - s * direction[2 * i - 1];
      reference[2 * i + 1] = s * direction[2 * i - 2] + c * direction[2 * i - 1];
    }
  }
  // Without the attribute, inlining and vectorisation depend on the other sources of the unity build.
  const auto along = [&](int i) __attribute__((always_inline))
  {
    return reference[2 * i] * direction[2 * i] + reference[2 * i + 1] * direction[2 * i + 1];
  };
  const auto across = [&](int i) __attribute__((always_inline))
  {
    return reference[2 * i] * direction[2 * i + 1] - reference[2 * i + 1] * direction[2 * i];
  };
  const auto bend = [&](int i, auto& rows, int k) __attribute__((always_inline))
  {
    const double turn = smallAngle(across(i) / along(i));
    const double angle = turn - natural_angle[i];
    moment[i] = stiffness[i] * angle + race * turn;
    rows[0][k] = 0.5 * stiffness[i] * angle * angle + 0.5 * race * turn * turn;
    // The count of large angles is a double like the sums, so that the compiler vectorises the loop.
    rows[1][k] = std::abs(across(i)) < SMALL_TANGENT * along(i) ? 0.0 : 1.0;
  };
  auto [energy, large] = blockSums<2>(0, n, bend);
  if (large > 0.0)
  {
    energy = 0.0;
    for (int i = 0; i < n; ++i)
    {
      const double turn = smallAngle(across(i), along(i));
      const double angle = turn - natural_angle[i];
      moment[i] = stiffness[i] * angle + race * turn;
      energy += 0.5 * stiffness[i] * angle * angle + 0.5 * race * turn * turn;
    }
  }
  sum.energy += energy;
}

HJT_VECTOR_CLONES void RimBending::addForces(const RingShape& shape, const DrivePosition&, Scratch& scratch,
                                             ForceSum& sum) const noexcept
{
  addMoments(shape, scratch, sum);
  const int n = shape.solved;
  const double* __restrict__ direction = shape.directions.data();
  const double* __restrict__ length = shape.lengths.data();
  const double* moment = scratch.moment.data();
  double* segment = sum.segment.data();
  const double shared = law_ == BendingLaw::CURVATURE ? 1.0 : 0.0;
  const auto turn_back = [&](int i, int j) __attribute__((always_inline))
  {
    const double scale = (moment[i] - shared * moment[j]) / length[i];
    segment[2 * i] = -scale * direction[2 * i + 1];
    segment[2 * i + 1] = scale * direction[2 * i];
  };
#pragma omp simd
  for (int i = 0; i < n - 1; ++i)
  {
    turn_back(i, i + 1);
  }
  turn_back(n - 1, 0);
  sum.addSegmentForces(n);
}

void RimBending::addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept
{
  addTurnTangent(shape, scratch, tangent);
  if (law_ == BendingLaw::CURVATURE)
  {
    addCurvatureTangent(shape, tangent);
  }
}

/// Adds the stiffness between the ends of each segment. This stiffness comes from the turn of the segment under its
/// couple and, with the absolute law, from bending.
HJT_VECTOR_CLONES void RimBending::addTurnTangent(const RingShape& shape, const Scratch& scratch,
                                                  RingTangent& tangent) const noexcept
{
  const int n = shape.solved;
  const double* __restrict__ direction = shape.directions.data();
  const double* __restrict__ length = shape.lengths.data();
  const double* moment = scratch.moment.data();
  const double* __restrict__ stiffness = stiffness_.data();
  const double race = race_;
  double* __restrict__ xx = tangent.segment.xx.data();
  double* __restrict__ xy = tangent.segment.xy.data();
  double* __restrict__ yy = tangent.segment.yy.data();
  const double shared = law_ == BendingLaw::CURVATURE ? 1.0 : 0.0;
  const auto turn = [&](int i, int j) __attribute__((always_inline))
  {
    const double x = direction[2 * i];
    const double y = direction[2 * i + 1];
    const double scale = 1.0 / (length[i] * length[i]);
    const double couple = scale * (moment[i] - shared * moment[j]);
    const double across = scale * (1.0 - shared) * (stiffness[i] + race);
    xx[i] = couple * 2.0 * x * y + across * y * y;
    xy[i] = couple * (y * y - x * x) - across * x * y;
    yy[i] = -couple * 2.0 * x * y + across * x * x;
  };
#pragma omp simd
  for (int i = 0; i < n - 1; ++i)
  {
    turn(i, i + 1);
  }
  turn(n - 1, 0);
  tangent.addSegments(n);
}

/// Writes the gradient g of the angle of each solved segment by the position of its far end [rad/m]. If half of the
/// ring is solved, also writes the gradients of the segments before and after this half.
inline void fillGradients(const RingShape& shape, double* __restrict__ gx, double* __restrict__ gy) noexcept
{
  const int n = shape.solved;
  const double* __restrict__ direction = shape.directions.data();
  const double* __restrict__ length = shape.lengths.data();
#pragma omp simd
  for (int i = 0; i < n; ++i)
  {
    const double inverse = 1.0 / length[i];
    gx[i] = -direction[2 * i + 1] * inverse;
    gy[i] = direction[2 * i] * inverse;
  }
  if (shape.copies() > 1)
  {
    const int before = shape.previous(0);
    const int after = shape.next(n - 1);
    gx[before] = -gx[n - 1];
    gy[before] = -gy[n - 1];
    gx[after] = -gx[0];
    gy[after] = -gy[0];
  }
}

/// Adds the bending stiffness between neighbouring segments: the stiffness times the outer product of the gradient of
/// the bending angle with itself. The gradient of the bending angle at tooth i is g_i (fillGradients) by the next
/// tooth, g_{i-1} by the preceding tooth, and -g_i - g_{i-1} by tooth i.
HJT_VECTOR_CLONES void RimBending::addCurvatureTangent(const RingShape& shape, RingTangent& tangent) const noexcept
{
  const int n = shape.solved;
  const double* __restrict__ rim = stiffness_.data();
  const double race = race_;
  double* __restrict__ gx = tangent.segment.xx.data();
  double* __restrict__ gy = tangent.segment.xy.data();
  fillGradients(shape, gx, gy);
  const int before = shape.previous(0);
  const int after = shape.next(n - 1);
  double* __restrict__ d_xx = tangent.diagonal.xx.data();
  double* __restrict__ d_xy = tangent.diagonal.xy.data();
  double* __restrict__ d_yy = tangent.diagonal.yy.data();
  double* __restrict__ n_xx = tangent.next.xx.data();
  double* __restrict__ n_xy = tangent.next.xy.data();
  double* __restrict__ n_yx = tangent.next.yx.data();
  double* __restrict__ n_yy = tangent.next.yy.data();
  double* __restrict__ s_xx = tangent.second.xx.data();
  double* __restrict__ s_xy = tangent.second.xy.data();
  double* __restrict__ s_yx = tangent.second.yx.data();
  double* __restrict__ s_yy = tangent.second.yy.data();
  const auto row = [&](int h, int i, int j) __attribute__((always_inline))
  {
    const double before_x = gx[i] + gx[h];
    const double before_y = gy[i] + gy[h];
    const double after_x = gx[i] + gx[j];
    const double after_y = gy[i] + gy[j];
    const double k_h = rim[h] + race;
    const double k_i = rim[i] + race;
    const double k_j = rim[j] + race;
    d_xx[i] += k_h * gx[h] * gx[h] + k_i * before_x * before_x + k_j * gx[i] * gx[i];
    d_xy[i] += k_h * gx[h] * gy[h] + k_i * before_x * before_y + k_j * gx[i] * gy[i];
    d_yy[i] += k_h * gy[h] * gy[h] + k_i * before_y * before_y + k_j * gy[i] * gy[i];
    n_xx[i] -= k_i * before_x * gx[i] + k_j * gx[i] * after_x;
    n_xy[i] -= k_i * before_x * gy[i] + k_j * gx[i] * after_y;
    n_yx[i] -= k_i * before_y * gx[i] + k_j * gy[i] * after_x;
    n_yy[i] -= k_i * before_y * gy[i] + k_j * gy[i] * after_y;
    s_xx[i] += k_j * gx[i] * gx[j];
    s_xy[i] += k_j * gx[i] * gy[j];
    s_yx[i] += k_j * gy[i] * gx[j];
    s_yy[i] += k_j * gy[i] * gy[j];
  };
  row(before, 0, 1);
#pragma omp simd
  for (int i = 1; i < n - 1; ++i)
  {
    row(i - 1, i, i + 1);
  }
  row(n - 2, n - 1, after);
}
}  // namespace hjt
