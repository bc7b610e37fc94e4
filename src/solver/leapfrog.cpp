// SPDX-License-Identifier: BSD-3-Clause
#include "solver/leapfrog.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
/// Speeds after a kick that without friction would bring a momentum [N.m.s]. On the surface the friction is in few
/// terms, and all is done to be quick.
Eigen::Vector2d rub(const JointDynamics& system, const DryFriction& friction, const Eigen::Vector2d& before,
                    const Eigen::Vector2d& momentum, double dt) noexcept
{
  Eigen::Vector2d after;
  if (system.onSurface() && friction.slide(system.friction(), system.velocityRatio(), before, momentum, dt, after))
  {
    return after;
  }
  return friction.solve(system.friction(), system.velocityRatio(), before, momentum.cwiseQuotient(friction.inertia()),
                        dt);
}

/// Speeds after a kick in which the drive's torque fades with the speed, as it is at the kick's end: one solution,
/// approached without overshoot however steep the fading. Leaves the drive's torque in `system`.
///
/// `others`: torques but the drive's and friction [N.m]; `kept`: of the drive's old torque [N.m]; `share`: of the
/// wanted torque that the current takes [-].
Eigen::Vector2d fade(JointDynamics& system, const Eigen::Vector2d& others, double kept, double share,
                     const Eigen::Vector2d& before, double dt) noexcept
{
  const Motor& motor = system.model().motor;
  const double wanted = system.inputs.motor_torque;
  const double gain = std::max(system.driveGain(), 0.0);
  const auto kick = [&](double torque, double slope)
  {
    // A torque that falls with the speed at the end is a larger inertia.
    Eigen::Vector2d inertia = system.inertia();
    const Eigen::Vector2d momentum = inertia.cwiseProduct(before) + dt * (others + Eigen::Vector2d(gain * torque, 0.0));
    inertia[0] += dt * gain * slope;
    return rub(system, system.dryFriction().withMotor(inertia[0]), before, momentum, dt);
  };
  Eigen::Vector2d after = kick(kept + share * motor.faded(wanted, 0.0), share * motor.fadeSlope(wanted));
  if (std::abs(after[0]) > motor.speedLimit())
  {
    after = kick(kept, 0.0);
  }
  system.drive_torque = kept + share * motor.faded(wanted, after[0]);
  return after;
}

/// Speeds after a kick by `others`, as of `fade`, and a drive that holds its torque back by the speed at the end or has
/// all of it, `full` [N.m]. Nearly always it is as it was at the start.
Eigen::Vector2d drive(JointDynamics& system, const Eigen::Vector2d& others, double full, double kept, double share,
                      const Eigen::Vector2d& before, double dt) noexcept
{
  const Motor& motor = system.model().motor;
  const double wanted = system.inputs.motor_torque;
  Eigen::Vector2d after;
  if (motor.fades(wanted, before[0]))
  {
    after = fade(system, others, kept, share, before, dt);
    if (motor.fades(wanted, after[0]))
    {
      return after;
    }
  }
  system.drive_torque = full;
  Eigen::Vector2d momentum = system.inertia().cwiseProduct(before) + dt * others;
  momentum[0] += dt * system.driveTorque();
  after = rub(system, system.dryFriction(), before, momentum, dt);
  return motor.fades(wanted, after[0]) ? fade(system, others, kept, share, before, dt) : after;
}
}  // namespace

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
  const Motor& motor = system.model().motor;
  const Eigen::Vector2d inertia = system.inertia();
  const double slipped = system.accept();
  const double wanted = system.inputs.motor_torque;
  const double lag = motor.currentLeft(dt);
  system.drive_torque = wanted + lag * (x[DRIVE_TORQUE] - wanted);
  system.updateFriction(before);
  const double presliding = system.preslidingTorque();
  const double full = system.drive_torque;
  system.drive_torque = 0.0;
  Eigen::Vector2d torque = system.torque();
  torque[0] += presliding;
  const Eigen::Vector2d after = drive(system, torque, full, lag * x[DRIVE_TORQUE], 1.0 - lag, before, dt);
  torque[0] += system.driveTorque();
  speeds_ = 0.5 * (before + after);
  const Eigen::Vector2d kick = inertia.cwiseProduct(after - before) / dt;
  friction_ = kick - torque;
  friction_[0] += presliding;
  x.segment<2>(MOTOR_ANGLE) = angles;
  x.segment<2>(MOTOR_SPEED) = after;
  x[DRIVE_TORQUE] = system.drive_torque;

  // Half of the kick's work belongs before the instant, half after: then the ledger's only error is the quadrature.
  const double motor_work = dt * system.driveTorque() * speeds_[0];
  const double load_work = dt * system.inputs.load_torque * speeds_[1];
  const double dissipated = -dt * friction_.dot(speeds_);
  x[DISSIPATED] += slipped;
  const double kinetic = 0.25 * (before.dot(inertia.cwiseProduct(before)) + after.dot(inertia.cwiseProduct(after)));
  balance_ = x[MOTOR_WORK] - x[LOAD_WORK] - x[DISSIPATED] + 0.5 * (motor_work - load_work - dissipated) - kinetic;
  delivered_ = x[LOAD_WORK] + 0.5 * load_work + 0.25 * inertia[1] * (before[1] * before[1] + after[1] * after[1]);
  link_torque_ = kick[1] + system.inputs.load_torque;
  work_ = { motor_work, load_work, dissipated };
  x.segment<3>(MOTOR_WORK) += work_;
}

void Leapfrog::goAhead(JointDynamics& system, JointState& x, double dt) noexcept
{
  using namespace joint_state;
  const double half = 0.5 * dt;
  const Eigen::Vector2d before = x.segment<2>(MOTOR_SPEED);
  const Eigen::Vector2d inertia = system.inertia();
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
