// SPDX-License-Identifier: BSD-3-Clause
#include "messages/tracker_outputs.hpp"

#include <algorithm>
#include <cmath>

#include "gear/ratio.hpp"
#include "messages/time.hpp"
#include "statics/inertia_error.hpp"

namespace hjt
{
MeasuredDrive::MeasuredDrive(const Parameters& parameters)
  : dimensions_(parameters.gear)
  , ring_(parameters.ring)
  , stress_(parameters.stress)
  , fatigue_law_(parameters.life, parameters.stress)
  , telemetry_(parameters.telemetry)
  , encoders_period_(toStampLength(1.0 / parameters.publish.encoders_rate))
  , ratio_(nominalRatio(parameters.gear))
  , gear_(parameters)
  , sensors_(parameters.sensors, 1.0 / parameters.publish.encoders_rate)
{
}

double MeasuredDrive::motorTorque(const Comparison& comparison) const noexcept
{
  return telemetry_.torque_per_current / ratio_ * (comparison.current.measured - telemetry_.current_offset);
}

void MeasuredDrive::note(const Comparison& comparison, bool is_wanted) noexcept
{
  if (!is_wanted)
  {
    since_ = {};
    return;
  }
  since_.motor_torque.add(motorTorque(comparison));
  since_.joint_torque.add(comparison.joint_torque);
}

double MeasuredDrive::meshForceError() const noexcept
{
  return expectedMeshForceError(ring_, dimensions_, ratio_ * now_.velocity.measured, now_.joint_torque);
}

bool MeasuredDrive::moveTo(const Comparison& comparison) noexcept
{
  now_ = comparison;
  motor_torque_ = motorTorque(comparison);
  const bool found = gear_.moveTo(comparison.position.measured, comparison.joint_torque);
  failures_ += found ? 0 : 1;
  return found;
}

void MeasuredDrive::fill(Stamp stamp, harmonic_joint_twin::ContactForces& message) noexcept
{
  fillContactForces(stamp, gear_, message);
  message.mesh_force_error = meshForceError();
}

void MeasuredDrive::fill(Stamp stamp, harmonic_joint_twin::Stress& message) noexcept
{
  fillStress(stamp, gear_, stress_, fatigue_law_, message);
}

void MeasuredDrive::fill(Stamp stamp, harmonic_joint_twin::Encoders& message) noexcept
{
  sensors_.update(stamp / encoders_period_, gear_.motorAngle(), gear_.position(), motor_torque_);
  fillEncoders(stamp, sensors_.encoders(), gear_.motorAngle(), gear_.position(), message);
}

void MeasuredDrive::fill(Stamp stamp, harmonic_joint_twin::Health& message) noexcept
{
  const LobeLoads lobes = gear_.lobes();
  message.header.stamp = toRosTime(stamp);
  message.torsion = gear_.torsion();
  message.torsional_stiffness_model = gear_.stiffness();
  message.teeth_loaded = static_cast<std::uint32_t>(lobes.teeth_loaded);
  std::copy(lobes.mesh_force.begin(), lobes.mesh_force.end(), message.lobe_mesh_force.begin());
  message.lobe_asymmetry = lobes.asymmetry;
  message.mesh_force_error = meshForceError();
  message.wave_generator_load = lobes.wave_generator_force;
  message.friction_torque = std::abs(now_.friction_torque) / ratio_;
  message.grease_temperature = now_.temperature;
  message.housing_temperature = now_.housing_temperature;
  message.motor_torque = motor_torque_;
  message.joint_torque = now_.joint_torque;
  since_.torsion.add(message.torsion);
  fillSpan(since_.torsion, message.torsion_min, message.torsion_mean, message.torsion_max);
  fillSpan(since_.motor_torque, message.motor_torque_min, message.motor_torque_mean, message.motor_torque_max);
  fillSpan(since_.joint_torque, message.joint_torque_min, message.joint_torque_mean, message.joint_torque_max);
  since_ = {};
  message.solver_residual = gear_.residual();
  message.solver_failures = failures_;
}
}  // namespace hjt
