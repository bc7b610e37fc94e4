// SPDX-License-Identifier: BSD-3-Clause
#include "solver/leapfrog.hpp"

namespace hjt
{
void Leapfrog::do_step(JointDynamics& system, JointState& x, double, double dt) noexcept
{
  using namespace joint_state;
  const Eigen::Vector2d before = x.segment<2>(MOTOR_SPEED);
  const Eigen::Vector2d angles = x.segment<2>(MOTOR_ANGLE) + dt * before;
  if (!system.place(angles[0], angles[1]).ok())
  {
    x.segment<2>(MOTOR_SPEED).setZero();
    speeds_.setZero();
    return;
  }
  const Eigen::Vector2d inertia = system.model().inertia();
  const double slipped = system.accept();
  system.updateFriction(before);
  const double presliding = system.preslidingTorque();
  Eigen::Vector2d torque = system.torque();
  torque[0] += presliding;
  const Eigen::Vector2d free = before + dt * torque.cwiseQuotient(inertia);
  Eigen::Vector2d after;
  // On the surface the friction is in few terms, and all is done to be quick.
  if (!system.onSurface() ||
      !system.dryFriction().slide(system.friction(), system.velocityRatio(), before, free, dt, after))
  {
    after = system.dryFriction().solve(system.friction(), system.velocityRatio(), before, free, dt);
  }
  speeds_ = 0.5 * (before + after);
  friction_ = inertia.cwiseProduct(after - free) / dt;
  friction_[0] += presliding;
  x.segment<2>(MOTOR_ANGLE) = angles;
  x.segment<2>(MOTOR_SPEED) = after;

  // Half of the kick's work belongs before the instant, half after: then the ledger's only error is the quadrature.
  const double motor_work = dt * system.driveTorque() * speeds_[0];
  const double load_work = dt * system.inputs.load_torque * speeds_[1];
  const double dissipated = -dt * friction_.dot(speeds_);
  x[DISSIPATED] += slipped;
  const double kinetic = 0.25 * (before.dot(inertia.cwiseProduct(before)) + after.dot(inertia.cwiseProduct(after)));
  balance_ = x[MOTOR_WORK] - x[LOAD_WORK] - x[DISSIPATED] + 0.5 * (motor_work - load_work - dissipated) - kinetic;
  work_ = { motor_work, load_work, dissipated };
  x.segment<3>(MOTOR_WORK) += work_;
}

void Leapfrog::goAhead(JointDynamics& system, JointState& x, double dt) noexcept
{
  using namespace joint_state;
  const double half = 0.5 * dt;
  const Eigen::Vector2d before = x.segment<2>(MOTOR_SPEED);
  const Eigen::Vector2d inertia = system.model().inertia();
  system.updateFriction(before);
  const double presliding = system.preslidingTorque();
  Eigen::Vector2d torque = system.torque();
  torque[0] += presliding;
  const Eigen::Vector2d free = before + half * torque.cwiseQuotient(inertia);
  const Eigen::Vector2d after =
      system.dryFriction().solve(system.friction(), system.velocityRatio(), before, free, half);
  Eigen::Vector2d friction = inertia.cwiseProduct(after - free) / half;
  friction[0] += presliding;
  x.segment<2>(MOTOR_SPEED) = after;
  x.segment<3>(MOTOR_WORK) += half * Eigen::Vector3d(system.driveTorque() * before[0],
                                                     system.inputs.load_torque * before[1], -friction.dot(before));
}

void Leapfrog::comeBack(JointState& x) const noexcept
{
  using namespace joint_state;
  x.segment<2>(MOTOR_SPEED) = speeds_;
  x.segment<3>(MOTOR_WORK) -= 0.5 * work_;
}
}  // namespace hjt
