// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/ring_damping.hpp"

#include "harmonic_joint_twin/elements/contact_ramp.hpp"

namespace hjt
{
namespace
{
/// Speed of the wave generator's surface along a tooth's normal, by its angular speed [m/rad].
double surfaceLever(const RingShape& shape, const RingForces& forces, int i) noexcept
{
  return shape.points[2 * i] * forces.contact_normal[2 * i + 1] -
         shape.points[2 * i + 1] * forces.contact_normal[2 * i];
}
}  // namespace

/// Dashpot between tooth i and the wave generator [N.s/m].
double RingDamping::contactStrength(const RingForces& forces, int i) const noexcept
{
  return forces.contact_force[i] > 0.0 ? contact_ * ContactRamp(forces.contact_depth[i], smoothing_).tangent : 0.0;
}

void RingDamping::add(const RingShape& shape, const RingForces& forces, const RingRates& rates,
                      JointFriction& friction) const noexcept
{
  const double* m = rates.by_motor.data();
  const double* o = rates.by_output.data();
  double mm = tooth_ * rates.by_motor.squaredNorm();
  double mo = tooth_ * rates.by_motor.dot(rates.by_output);
  double oo = tooth_ * rates.by_output.squaredNorm();
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    const double dx = shape.directions[2 * i];
    const double dy = shape.directions[2 * i + 1];
    const double stretch_m = dx * (m[2 * j] - m[2 * i]) + dy * (m[2 * j + 1] - m[2 * i + 1]);
    const double stretch_o = dx * (o[2 * j] - o[2 * i]) + dy * (o[2 * j + 1] - o[2 * i + 1]);
    const double nx = forces.contact_normal[2 * i];
    const double ny = forces.contact_normal[2 * i + 1];
    const double contact = contactStrength(forces, i);
    const double depth_m = surfaceLever(shape, forces, i) - nx * m[2 * i] - ny * m[2 * i + 1];
    const double depth_o = -nx * o[2 * i] - ny * o[2 * i + 1];
    mm += tension_ * stretch_m * stretch_m + contact * depth_m * depth_m;
    mo += tension_ * stretch_m * stretch_o + contact * depth_m * depth_o;
    oo += tension_ * stretch_o * stretch_o + contact * depth_o * depth_o;
  }
  friction.viscous(0, 0) += mm;
  friction.viscous(0, 1) += mo;
  friction.viscous(1, 0) += mo;
  friction.viscous(1, 1) += oo;
}

DashpotPower RingDamping::addForces(const RingShape& shape, const RingForces& forces, const Eigen::VectorXd& speeds,
                                    const Eigen::VectorXd& growth, Eigen::VectorXd& force) const noexcept
{
  DashpotPower power;
  const int n = shape.teeth();
  const int wave_generator = 2 * n;
  force.head(2 * n) -= tooth_ * speeds.head(2 * n);
  power.dissipated += tooth_ * speeds.head(2 * n).squaredNorm();
  for (int i = 0; i < n; ++i)
  {
    const int j = shape.next(i);
    const Eigen::Vector2d along = shape.directions.segment<2>(2 * i);
    const double stretch_rate = along.dot(speeds.segment<2>(2 * j) - speeds.segment<2>(2 * i));
    force.segment<2>(2 * i) += tension_ * stretch_rate * along;
    force.segment<2>(2 * j) -= tension_ * stretch_rate * along;
    power.dissipated += tension_ * stretch_rate * stretch_rate;

    const double contact = contactStrength(forces, i);
    if (contact == 0.0)
    {
      continue;
    }
    const Eigen::Vector2d normal = forces.contact_normal.segment<2>(2 * i);
    const double lever = surfaceLever(shape, forces, i);
    const double depth_rate = lever * speeds[wave_generator] + growth[i] - normal.dot(speeds.segment<2>(2 * i));
    force.segment<2>(2 * i) += contact * depth_rate * normal;
    force[wave_generator] -= contact * depth_rate * lever;
    power.dissipated += contact * depth_rate * depth_rate;
    power.supplied += contact * depth_rate * growth[i];
  }
  return power;
}

void RingDamping::addTangent(const RingShape& shape, const RingForces& forces, double scale,
                             RingTangent& tangent) const noexcept
{
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const int j = shape.next(i);
    const Eigen::Vector2d along = shape.directions.segment<2>(2 * i);
    const Block2 stretch = scale * tension_ * along * along.transpose();
    const Eigen::Vector2d normal = forces.contact_normal.segment<2>(2 * i);
    const double contact = scale * contactStrength(forces, i);
    const double lever = surfaceLever(shape, forces, i);
    tangent.addDiagonal(i, scale * tooth_ * Block2::Identity() + stretch + contact * normal * normal.transpose());
    tangent.addDiagonal(j, stretch);
    tangent.addPair(i, j, -stretch);
    tangent.wave_generator.segment<2>(2 * i) -= contact * lever * normal;
    tangent.wave_generator_stiffness += contact * lever * lever;
  }
}
}  // namespace hjt
