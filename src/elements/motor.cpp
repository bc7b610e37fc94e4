// SPDX-License-Identifier: BSD-3-Clause
#include "elements/motor.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
Motor::Drive Motor::drive(double command, double speed) const noexcept
{
  constexpr double FADE = 0.02;  // share of the speed limit over which torque fades out
  Drive drive;
  drive.torque = std::clamp(command, -parameters_.torque_limit, parameters_.torque_limit);
  drive.clamped = drive.torque != command;
  const double room = (1.0 - std::abs(speed) / parameters_.speed_limit) / FADE;
  drive.held = room < 1.0 && drive.torque * speed > 0.0;
  drive.slope = 0.0;
  if (drive.held)
  {
    drive.slope = std::abs(drive.torque) / (FADE * parameters_.speed_limit);
    drive.torque *= std::max(room, 0.0);
  }
  return drive;
}
}  // namespace hjt
