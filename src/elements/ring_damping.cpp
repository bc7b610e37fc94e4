// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/ring_damping.hpp"

#include "harmonic_joint_twin/elements/contact_ramp.hpp"
#include "harmonic_joint_twin/gear/vector_clones.hpp"

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

HJT_VECTOR_CLONES void RingDamping::add(const RingShape& shape, const RingForces& forces, const RingRates& rates,
                                        JointFriction& friction) const noexcept
{
  const int n = shape.teeth();
  const double* m = rates.by_motor.data();
  const double* o = rates.by_output.data();
  const double* direction = shape.directions.data();
  const double* point = shape.points.data();
  const double* normal = forces.contact_normal.data();
  const double* depth = forces.contact_depth.data();
  const double smoothing = smoothing_;
  const auto stretch = [&](const double* rate, int i, int j) {
    return direction[2 * i] * (rate[2 * j] - rate[2 * i]) + direction[2 * i + 1] * (rate[2 * j + 1] - rate[2 * i + 1]);
  };
  const auto inward = [&](const double* rate, int i)
  { return normal[2 * i] * rate[2 * i] + normal[2 * i + 1] * rate[2 * i + 1]; };
  const double last_m = stretch(m, n - 1, 0);
  const double last_o = stretch(o, n - 1, 0);
  double mm = tension_ * last_m * last_m;
  double mo = tension_ * last_m * last_o;
  double oo = tension_ * last_o * last_o;
#pragma omp simd reduction(+ : mm, mo, oo)
  for (int i = 0; i < n - 1; ++i)
  {
    const double stretch_m = stretch(m, i, i + 1);
    const double stretch_o = stretch(o, i, i + 1);
    mm += tension_ * stretch_m * stretch_m;
    mo += tension_ * stretch_m * stretch_o;
    oo += tension_ * stretch_o * stretch_o;
  }
#pragma omp simd reduction(+ : mm, mo, oo)
  for (int i = 0; i < n; ++i)
  {
    const double dashpot = contact_ * ContactRamp(depth[i], smoothing).tangent;
    const double surface = point[2 * i] * normal[2 * i + 1] - point[2 * i + 1] * normal[2 * i];
    const double depth_m = surface - inward(m, i);
    const double depth_o = -inward(o, i);
    mm += dashpot * depth_m * depth_m + tooth_ * (m[2 * i] * m[2 * i] + m[2 * i + 1] * m[2 * i + 1]);
    mo += dashpot * depth_m * depth_o + tooth_ * (m[2 * i] * o[2 * i] + m[2 * i + 1] * o[2 * i + 1]);
    oo += dashpot * depth_o * depth_o + tooth_ * (o[2 * i] * o[2 * i] + o[2 * i + 1] * o[2 * i + 1]);
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
