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
  if (!std::isfinite(message.position[joint]) || !std::isfinite(message.effort[joint]))
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
  return TelemetryStatus::FOUND;
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
}  // namespace hjt
