// SPDX-License-Identifier: BSD-3-Clause
#include "solver/leapfrog.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
/// Speeds for the strength of friction in a kick: of each speed the mean amount over it, by the line through the
/// speeds at its begin and half a kick earlier [rad/s].
Eigen::Vector2d rubbingSpeeds(const Eigen::Vector2d& before, const Eigen::Vector2d& earlier) noexcept
{
  Eigen::Vector2d mean;
  for (int i = 0; i < 2; ++i)
  {
    const double from = std::abs(before[i]);
    const double to = 3.0 * before[i] - 2.0 * earlier[i];
    const bool turns = before[i] * to < 0.0;
    const double amount = turns ? 0.5 * (from * from + to * to) / (from + std::abs(to)) : 0.5 * (from + std::abs(to));
    mean[i] = from > 0.0 ? std::copysign(amount, before[i]) : 0.0;
  }
  return mean;
}

/// Speeds after a kick that without friction would bring a momentum [N.m.s]. On the surface the friction is in few
/// terms, and all is done to be quick.
KickedSpeeds rub(JointDynamics& system, const DryFriction& friction, const Eigen::Vector2d& before,
                 const Eigen::Vector2d& momentum, double dt) noexcept
{
  Eigen::Vector2d after;
  if (system.onSurface() && friction.slide(system.friction(), system.velocityRatio(), before, momentum, dt, after))
  {
    return { after, 0.5 * (before + after) };
  }
  return system.stopOrSlide(friction, before, momentum, dt);
}

/// Speeds after a kick in which the drive's torque fades with the speed, as it is at the kick's end: one solution,
/// approached without overshoot however steep the fading. Leaves the drive's torque in `system`.
///
/// `others`: torques but the drive's and friction [N.m]; `kept`: of the drive's old torque [N.m]; `share`: of the
/// wanted torque that the current takes [-].
KickedSpeeds fade(JointDynamics& system, const Eigen::Vector2d& others, double kept, double share,
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
  KickedSpeeds speeds = kick(kept + share * motor.faded(wanted, 0.0), share * motor.fadeSlope(wanted));
  if (std::abs(speeds.after[0]) > motor.speedLimit())
  {
    speeds = kick(kept, 0.0);
  }
  system.drive_torque = kept + share * motor.faded(wanted, speeds.after[0]);
  return speeds;
}

/// Speeds after a kick by `others`, as of `fade`, and a drive that holds its torque back by the speed at the end or has
/// all of it, `full` [N.m]. Nearly always it is as it was at the start.
KickedSpeeds drive(JointDynamics& system, const Eigen::Vector2d& others, double full, double kept, double share,
                   const Eigen::Vector2d& before, double dt) noexcept
{
  const Motor& motor = system.model().motor;
  const double wanted = system.inputs.motor_torque;
  if (motor.fades(wanted, before[0]))
  {
    const KickedSpeeds faded = fade(system, others, kept, share, before, dt);
    if (motor.fades(wanted, faded.after[0]))
    {
      return faded;
    }
  }
  system.drive_torque = full;
  Eigen::Vector2d momentum = system.inertia().cwiseProduct(before) + dt * others;
  momentum[0] += dt * system.driveTorque();
  const KickedSpeeds speeds = rub(system, system.dryFriction(), before, momentum, dt);
  return motor.fades(wanted, speeds.after[0]) ? fade(system, others, kept, share, before, dt) : speeds;
}
}  // namespace

/// Speeds after a kick over `dt`. `rubbing`: speeds that friction's strength is taken at [rad/s]; `lag`: what is left
/// of the drive's torque that the last kick had [-].
KickedSpeeds Leapfrog::kick(JointDynamics& system, JointState& x, const Eigen::Vector2d& before,
                            const Eigen::Vector2d& rubbing, double lag, double dt) noexcept
{
  const Eigen::Vector2d inertia = system.inertia();
  const double wanted = system.inputs.motor_torque;
  const double kept = lag * x[joint_state::DRIVE_TORQUE];
  const double full = wanted + lag * (x[joint_state::DRIVE_TORQUE] - wanted);
  system.drive_torque = full;
  system.updateFriction(rubbing);
  const double presliding = system.preslidingTorque();
  system.drive_torque = 0.0;
  Eigen::Vector2d torque = system.torque();
  torque[0] += presliding;
  const KickedSpeeds speeds = drive(system, torque, full, kept, 1.0 - lag, before, dt);
  torque[0] += system.driveTorque();
  const Eigen::Vector2d kicked = inertia.cwiseProduct(speeds.after - before) / dt;
  friction_ = kicked - torque;
  friction_[0] += presliding;
  link_torque_ = kicked[1] + system.inputs.load();
  x[joint_state::DRIVE_TORQUE] = system.drive_torque;
  inertia_ = inertia;
  acted_ = system.inputs;
  return speeds;
}

/// The present inputs act on the speeds otherwise than those of the last kick. A current that lags does not
/// jump; the arm's load belongs to a step's end.
bool Leapfrog::actOtherwise(const JointDynamics& system) const noexcept
{
  const JointInputs& now = system.inputs;
  return !moves_ || (now.motor_torque != acted_.motor_torque && system.model().motor.currentRate() == 0.0) ||
         now.load_torque != acted_.load_torque || now.brake_engaged != acted_.brake_engaged;
}

void Leapfrog::do_step(JointDynamics& system, JointState& x, double, double dt) noexcept
{
  using namespace joint_state;
  if (actOtherwise(system))
  {
    retake(system, x, dt);
  }
  const Eigen::Vector2d before = x.segment<2>(MOTOR_SPEED);
  const Eigen::Vector2d angles = x.segment<2>(MOTOR_ANGLE) + dt * before;
  if (!system.place(angles[0], angles[1]).ok())
  {
    stop(system, x);
    return;
  }
  const Eigen::Vector2d inertia = system.inertia();
  const double slipped = system.accept();
  const KickedSpeeds kicked =
      kick(system, x, before, rubbingSpeeds(before, halfway_), system.model().motor.currentLeft(dt), dt);
  const Eigen::Vector2d& after = kicked.after;
  speeds_ = 0.5 * (before + after);
  halfway_ = kicked.halfway;
  half_kick_ = after - speeds_;
  x.segment<2>(MOTOR_ANGLE) = angles;
  x.segment<2>(MOTOR_SPEED) = after;

  // The work over half of the way belongs before the instant, the rest after: then the ledger's only error is the
  // quadrature.
  const Eigen::Vector3d until = works(system, before, dt);
  rest_ = works(system, after, dt);
  x[DISSIPATED] += slipped;
  const Eigen::Vector2d kinetic = 0.5 * inertia.cwiseProduct(before.cwiseProduct(after)) - retaken_;
  balance_ = x[MOTOR_WORK] - x[LOAD_WORK] - x[DISSIPATED] + until[0] - until[1] - until[2] - kinetic.sum();
  delivered_ = x[LOAD_WORK] + until[1] + kinetic[1];
  x.segment<3>(MOTOR_WORK) += until + rest_;
}

/// Of the last kick's torques over half a step at these speeds, in the order of the state [J].
Eigen::Vector3d Leapfrog::works(const JointDynamics& system, const Eigen::Vector2d& speeds, double dt) const noexcept
{
  return 0.5 * dt *
         Eigen::Vector3d(system.driveTorque() * speeds[0], system.inputs.load() * speeds[1], -friction_.dot(speeds));
}

void Leapfrog::retake(JointDynamics& system, JointState& x, double dt) noexcept
{
  using namespace joint_state;
  const Eigen::Vector2d inertia = system.inertia();
  if (!moves_)
  {
    moves_ = true;
    speeds_ = x.segment<2>(MOTOR_SPEED);
    halfway_ = speeds_;
    half_kick_.setZero();
    rest_.setZero();
    inertia_ = inertia;
  }
  x.segment<3>(MOTOR_WORK) -= rest_;
  retaken_ += 0.5 * inertia_.cwiseProduct(half_kick_.cwiseAbs2());
  // Where something stopped within the kick, the speed half way is not the mean that its works are of.
  x[DISSIPATED] += 0.5 * inertia_.dot(speeds_.cwiseAbs2() - halfway_.cwiseAbs2());
  // An arm changed the output's inertia at the speeds that are taken back.
  x[LOAD_WORK] += 0.5 * (inertia - inertia_).dot(x.segment<2>(MOTOR_SPEED).cwiseAbs2() - halfway_.cwiseAbs2());
  speeds_ = halfway_;

  const double half = 0.5 * dt;
  const double arm_torque = system.inputs.arm_torque;
  system.inputs.arm_torque = acted_.arm_torque;
  const bool lags = system.model().motor.currentRate() > 0.0;
  const Eigen::Vector2d after = kick(system, x, speeds_, speeds_, lags ? 1.0 : 0.0, half).after;
  half_kick_ = after - speeds_;
  retaken_ -= 0.5 * inertia.cwiseProduct(half_kick_.cwiseAbs2());
  rest_ = works(system, after, dt);
  x.segment<2>(MOTOR_SPEED) = after;
  x.segment<3>(MOTOR_WORK) += rest_;
  system.inputs.arm_torque = arm_torque;
}

/// At the last instant.
void Leapfrog::stop(const JointDynamics& system, JointState& x) noexcept
{
  using namespace joint_state;
  x.segment<3>(MOTOR_WORK) -= rest_;
  const Eigen::Vector2d kinetic =
      0.5 * system.inertia().cwiseProduct(speeds_.cwiseAbs2() - half_kick_.cwiseAbs2()) - retaken_;
  x[DISSIPATED] += kinetic.sum();
  x.segment<2>(MOTOR_SPEED).setZero();
  speeds_.setZero();
  retaken_.setZero();
  rest_.setZero();
  moves_ = false;
  balance_ = x[MOTOR_WORK] - x[LOAD_WORK] - x[DISSIPATED];
  delivered_ = x[LOAD_WORK];
}
}  // namespace hjt
