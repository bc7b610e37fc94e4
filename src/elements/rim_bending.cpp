// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/rim_bending.hpp"

#include <cmath>

#include "harmonic_joint_twin/gear/angle.hpp"

namespace hjt
{
namespace
{
/// Gradient of a segment's rotation by the position of its far end: across / length. [rad/m]
Eigen::Vector2d turnGradient(const RingShape& shape, int i) noexcept
{
  return Eigen::Vector2d(-shape.directions[2 * i + 1], shape.directions[2 * i]) / shape.lengths[i];
}

/// Second derivative of a segment's rotation by the position of its far end. [rad/m^2]
Block2 turnHessian(const RingShape& shape, int i) noexcept
{
  const double x = shape.directions[2 * i];
  const double y = shape.directions[2 * i + 1];
  const double scale = 1.0 / (shape.lengths[i] * shape.lengths[i]);
  Block2 block;
  block << 2.0 * x * y, y * y - x * x, y * y - x * x, -2.0 * x * y;
  return scale * block;
}
}  // namespace

RimBending::RimBending(const RingParameters& parameters, const ToothRing& rest)
  : law_(parameters.bending_law)
  , stiffness_(Eigen::VectorXd::Constant(rest.teeth(), parameters.bending_stiffness))
  , rest_directions_(rest.segments())
  , rest_cos_(std::cos(rest.pitchAngle()))
  , rest_sin_(std::sin(rest.pitchAngle()))
{
}

/// The angle that stiffness_[i] resists [rad].
double RimBending::bend(const RingShape& shape, int i) const noexcept
{
  const double x = shape.directions[2 * i];
  const double y = shape.directions[2 * i + 1];
  if (law_ == BendingLaw::ABSOLUTE)
  {
    const double rx = rest_directions_[2 * i];
    const double ry = rest_directions_[2 * i + 1];
    return smallAngle(rx * y - ry * x, rx * x + ry * y);
  }
  const int h = shape.previous(i);
  const double px = shape.directions[2 * h];
  const double py = shape.directions[2 * h + 1];
  const double rx = rest_cos_ * px - rest_sin_ * py;
  const double ry = rest_sin_ * px + rest_cos_ * py;
  return smallAngle(rx * y - ry * x, rx * x + ry * y);
}

/// Couple that turns segment i back [N.m].
double RimBending::couple(const RingForces& forces, int i, int next) const noexcept
{
  return law_ == BendingLaw::ABSOLUTE ? forces.bending_moment[i] :
                                        forces.bending_moment[i] - forces.bending_moment[next];
}

double RimBending::bendingForce(const RingShape& shape, const RingForces& forces, int i) const noexcept
{
  return couple(forces, i, shape.next(i)) / shape.lengths[i];
}

void RimBending::addForces(const RingShape& shape, RingForces& forces) const noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double angle = bend(shape, i);
    forces.bending_moment[i] = stiffness_[i] * angle;
    forces.energy += 0.5 * forces.bending_moment[i] * angle;
  }
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    const double scale = couple(forces, i, j) / shape.lengths[i];
    const double fx = -scale * shape.directions[2 * i + 1];
    const double fy = scale * shape.directions[2 * i];
    forces.teeth[2 * i] += fx;
    forces.teeth[2 * i + 1] += fy;
    forces.teeth[2 * j] -= fx;
    forces.teeth[2 * j + 1] -= fy;
  }
}

void RimBending::addTangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept
{
  if (law_ == BendingLaw::ABSOLUTE)
  {
    addAbsoluteTangent(shape, forces, tangent);
  }
  else
  {
    addCurvatureTangent(shape, forces, tangent);
  }
}

void RimBending::addAbsoluteTangent(const RingShape& shape, const RingForces& forces,
                                    RingTangent& tangent) const noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    const Eigen::Vector2d g = turnGradient(shape, i);
    const Block2 block = stiffness_[i] * g * g.transpose() + forces.bending_moment[i] * turnHessian(shape, i);
    tangent.addDiagonal(i, block);
    tangent.addDiagonal(j, block);
    tangent.addPair(i, j, -block);
  }
}

void RimBending::addCurvatureTangent(const RingShape& shape, const RingForces& forces,
                                     RingTangent& tangent) const noexcept
{
  const int n = shape.teeth();
  Eigen::Vector2d g_before = turnGradient(shape, n - 1);
  for (int i = 0; i < n; ++i)
  {
    const int h = shape.previous(i);
    const int j = shape.next(i);
    const Eigen::Vector2d g = turnGradient(shape, i);
    // Gradient of the bend at tooth i: g at j, g_before at h, minus both at i.
    const Eigen::Vector2d at_tooth = -(g + g_before);
    const double k = stiffness_[i];
    const Block2 turn = couple(forces, i, j) * turnHessian(shape, i);
    tangent.addDiagonal(h, k * g_before * g_before.transpose());
    tangent.addDiagonal(i, k * at_tooth * at_tooth.transpose() + turn);
    tangent.addDiagonal(j, k * g * g.transpose() + turn);
    tangent.addPair(h, i, k * g_before * at_tooth.transpose());
    tangent.addPair(i, j, k * at_tooth * g.transpose() - turn);
    tangent.addPair(h, j, k * g_before * g.transpose());
    g_before = g;
  }
}
}  // namespace hjt
