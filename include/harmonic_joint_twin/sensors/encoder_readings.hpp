// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace hjt
{
/// Readings of the encoders at the motor and at the output.
struct EncoderReadings
{
  std::int64_t motor_count{};    ///< count of the motor's encoder since the start
  double motor_angle{};          ///< angle of the motor since the start [rad]
  double motor_velocity{};       ///< mean speed of the motor over sensors.velocity_window [rad/s]
  std::uint32_t output_count{};  ///< count of the output's absolute encoder within a turn
  double output_angle{};         ///< angle of the output, including whole turns [rad]
  double output_velocity{};      ///< mean speed of the output over sensors.velocity_window [rad/s]
};
}  // namespace hjt
