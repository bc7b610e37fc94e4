// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace hjt
{
/// Readings of both encoders.
struct EncoderReadings
{
  std::int64_t motor_count{};    ///< counts since the start
  double motor_angle{};          ///< [rad]
  double motor_velocity{};       ///< difference over the velocity window [rad/s]
  std::uint32_t output_count{};  ///< absolute, within a turn
  double output_angle{};         ///< unwrapped [rad]
  double output_velocity{};      ///< [rad/s]
};
}  // namespace hjt
