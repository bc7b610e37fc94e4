// SPDX-License-Identifier: BSD-3-Clause
#include "messages/tracker_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gear/ratio.hpp"
#include "messages/time.hpp"
#include "statics/inertia_error.hpp"

namespace hjt
{
TelemetryStatus readTelemetry(const sensor_msgs::JointState& message, const JointNames& names, MotionRow& row) noexcept
{
  const std::size_t joint = placeOf(message, names.joint);
  if (joint >= message.name.size())
  {
    return TelemetryStatus::UNKNOWN_JOINT;
  }
  if (joint >= message.position.size() || joint >= message.effort.size())
  {
    return TelemetryStatus::INCOMPLETE;
  }
  if (!std::isfinite(message.position[joint]))
  {
    return TelemetryStatus::NOT_FINITE;
  }
  row.position = message.position[joint];
  row.current = message.effort[joint];
  row.recorded_velocity =
      joint < message.velocity.size() ? message.velocity[joint] : std::numeric_limits<double>::quiet_NaN();
  const std::size_t motor = placeOf(message, names.motor);
  row.motor_angle =
      motor < message.position.size() ? message.position[motor] : std::numeric_limits<double>::quiet_NaN();
  return std::isfinite(row.current) ? TelemetryStatus::FOUND : TelemetryStatus::WITHOUT_EFFORT;
}

void fillComparison(Stamp stamp, const Comparison& comparison, harmonic_joint_twin::Comparison& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.position_measured = comparison.position.measured;
  message.position_predicted = comparison.position.predicted;
  message.position_residual = comparison.position.residual();
  message.position_band = comparison.position.band;
  message.velocity_measured = comparison.velocity.measured;
  message.velocity_predicted = comparison.velocity.predicted;
  message.velocity_residual = comparison.velocity.residual();
  message.current_measured = comparison.current.measured;
  message.current_predicted = comparison.current.predicted;
  message.current_residual = comparison.current.residual();
  message.current_band = comparison.current.band;
  message.residual_torque = comparison.residual_torque;
  message.joint_torque = comparison.joint_torque;
  message.friction_torque = comparison.friction_torque;
  message.load_torque = comparison.load_torque;
  message.load_told = comparison.load_provided;
  message.temperature = comparison.temperature;
  message.temperature_received = comparison.temperature_received;
  message.sticking = comparison.sticking;
  message.after_gap = comparison.after_gap;
  message.outside_band = comparison.isOutside();
}

void fillVerdict(Stamp stamp, const Verdict& verdict, harmonic_joint_twin::Verdict& message)
{
  message.header.stamp = toRosTime(stamp);
  message.joint = verdict.joint;
  message.level = static_cast<std::uint8_t>(verdict.level);
  message.reason = static_cast<std::uint8_t>(verdict.reason);
  message.friction_measured = std::isfinite(verdict.friction.factor);
  message.friction_factor = message.friction_measured ? verdict.friction.factor : 0.0;
  message.friction_lower = message.friction_measured ? verdict.friction.lower : 0.0;
  message.friction_upper = message.friction_measured ? verdict.friction.upper : 0.0;
  message.friction_has_interval = verdict.friction.has_interval;
  message.causes.clear();
  message.cause_weights.clear();
  for (const WeightedCause& cause : causesOf(verdict))
  {
    message.causes.emplace_back(causeName(cause.cause));
    message.cause_weights.push_back(cause.weight);
  }
  message.evidence_names.clear();
  message.evidence_values.clear();
  message.evidence_units.clear();
  for (const NamedFigure& figure : evidenceOf(verdict))
  {
    message.evidence_names.push_back(figure.name);
    message.evidence_values.push_back(figure.value);
    message.evidence_units.emplace_back(figure.unit);
  }
  message.text = verdictText(verdict);
}

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
