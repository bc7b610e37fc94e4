// SPDX-License-Identifier: BSD-3-Clause
#include "messages/telemetry_messages.hpp"

#include <cmath>
#include <limits>

#include "messages/time.hpp"

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
}  // namespace hjt
