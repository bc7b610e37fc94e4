// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

namespace hjt
{
constexpr double NOT_MEASURED = std::numeric_limits<double>::quiet_NaN();

/// What a drive's own sensors tell at one instant. What is not measured stays NaN: without one of the encoders only
/// what needs both is missing, without a load estimate only efficiency, without set points only the lag.
struct SignalSample
{
  std::int64_t stamp{};                   ///< [ns]
  double motor_angle{ NOT_MEASURED };     ///< encoder, without jumps at full turns [rad]
  double output_angle{ NOT_MEASURED };    ///< encoder, without jumps at full turns [rad]
  double motor_velocity{ NOT_MEASURED };  ///< [rad/s]
  double motor_torque{ NOT_MEASURED };    ///< at the shaft: commanded, or current times torque constant [N.m]
  double load_torque{ NOT_MEASURED };     ///< estimate at the output, > 0 resists positive motion [N.m]
  double temperature{ NOT_MEASURED };     ///< [degC]
  double target_angle{ NOT_MEASURED };    ///< set point of the output angle [rad]
};
}  // namespace hjt
