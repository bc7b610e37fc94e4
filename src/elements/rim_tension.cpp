// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/rim_tension.hpp"

namespace hjt
{
RimTension::RimTension(const RingParameters& parameters, const ToothRing& rest)
  : stiffness_(Eigen::VectorXd::Constant(rest.teeth(), parameters.tension_stiffness))
  , rest_length_(rest.segmentLength())
{
}

void RimTension::addForces(const RingShape& shape, RingForces& forces) const noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    const double stretch = shape.lengths[i] - rest_length_;
    const double pull = stiffness_[i] * stretch;
    const Eigen::Vector2d force = pull * shape.directions.segment<2>(2 * i);
    forces.teeth.segment<2>(2 * i) += force;
    forces.teeth.segment<2>(2 * j) -= force;
    forces.energy += 0.5 * pull * stretch;
  }
}

void RimTension::addTangent(const RingShape& shape, RingTangent& tangent) const noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    // k u u^T along the segment, tension / length across it.
    const double across = tension(shape, i) / shape.lengths[i];
    const double x = shape.directions[2 * i];
    const double y = shape.directions[2 * i + 1];
    const double along = stiffness_[i] - across;
    Block2 block;
    block << across + along * x * x, along * x * y, along * x * y, across + along * y * y;
    tangent.addDiagonal(i, block);
    tangent.addDiagonal(j, block);
    tangent.addPair(i, j, -block);
  }
}
}  // namespace hjt
