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

double RimBending::bendingForce(const RingShape& shape, int i) const noexcept
{
  double couple = stiffness_[i] * bend(shape, i);
  if (law_ == BendingLaw::CURVATURE)
  {
    const int j = shape.next(i);
    couple -= stiffness_[j] * bend(shape, j);
  }
  return couple / shape.lengths[i];
}

void RimBending::addForces(const RingShape& shape, RingForces& forces) const noexcept
{
  const int n = shape.teeth();
  double moment = stiffness_[0] * bend(shape, 0);
  const double first_moment = moment;
  forces.energy += stiffness_[0] > 0.0 ? 0.5 * moment * moment / stiffness_[0] : 0.0;
  for (int i = 0; i < n; ++i)
  {
    const int j = shape.next(i);
    double next_moment = first_moment;
    if (j != 0)
    {
      const double angle = bend(shape, j);
      next_moment = stiffness_[j] * angle;
      forces.energy += 0.5 * next_moment * angle;
    }
    const double couple = law_ == BendingLaw::ABSOLUTE ? moment : moment - next_moment;
    const double scale = couple / shape.lengths[i];
    const double fx = -scale * shape.directions[2 * i + 1];
    const double fy = scale * shape.directions[2 * i];
    forces.teeth[2 * i] += fx;
    forces.teeth[2 * i + 1] += fy;
    forces.teeth[2 * j] -= fx;
    forces.teeth[2 * j + 1] -= fy;
    moment = next_moment;
  }
}

void RimBending::addTangent(const RingShape& shape, RingTangent& tangent) const noexcept
{
  if (law_ == BendingLaw::ABSOLUTE)
  {
    addAbsoluteTangent(shape, tangent);
  }
  else
  {
    addCurvatureTangent(shape, tangent);
  }
}

void RimBending::addAbsoluteTangent(const RingShape& shape, RingTangent& tangent) const noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    const Eigen::Vector2d g = turnGradient(shape, i);
    const Block2 block = stiffness_[i] * (g * g.transpose() + bend(shape, i) * turnHessian(shape, i));
    tangent.addDiagonal(i, block);
    tangent.addDiagonal(j, block);
    tangent.addPair(i, j, -block);
  }
}

void RimBending::addCurvatureTangent(const RingShape& shape, RingTangent& tangent) const noexcept
{
  const int n = shape.teeth();
  Eigen::Vector2d g_before = turnGradient(shape, n - 1);
  double moment = stiffness_[0] * bend(shape, 0);
  const double first_moment = moment;
  for (int i = 0; i < n; ++i)
  {
    const int h = shape.previous(i);
    const int j = shape.next(i);
    const double next_moment = j == 0 ? first_moment : stiffness_[j] * bend(shape, j);
    const Eigen::Vector2d g = turnGradient(shape, i);
    // Gradient of the bend at tooth i: g at j, g_before at h, minus both at i.
    const Eigen::Vector2d at_tooth = -(g + g_before);
    const double k = stiffness_[i];
    const Block2 turn = (moment - next_moment) * turnHessian(shape, i);
    tangent.addDiagonal(h, k * g_before * g_before.transpose());
    tangent.addDiagonal(i, k * at_tooth * at_tooth.transpose() + turn);
    tangent.addDiagonal(j, k * g * g.transpose() + turn);
    tangent.addPair(h, i, k * g_before * at_tooth.transpose());
    tangent.addPair(i, j, k * at_tooth * g.transpose() - turn);
    tangent.addPair(h, j, k * g_before * g.transpose());
    g_before = g;
    moment = next_moment;
  }
}
}  // namespace hjt
