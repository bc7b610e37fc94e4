// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/stamp.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Beyond these a message was damaged [s], [rad], [A] or [N.m].
constexpr double MAX_TIME = 1e-9 * static_cast<double>(MAX_STAMP);
constexpr double MAX_ANGLE = 1.0e4;
constexpr double MAX_EFFORT = 1.0e4;

inline bool isPlausibleEffort(double effort) noexcept
{
  return std::abs(effort) <= MAX_EFFORT;  // false for NaN
}

/// The motor's angle may be missing.
inline bool isPlausible(const MotionRow& row) noexcept
{
  return std::abs(row.time) < MAX_TIME && std::abs(row.position) < MAX_ANGLE && isPlausibleEffort(row.current) &&
         !(std::abs(row.motor_angle) > MAX_ANGLE * MAX_ANGLE);
}

/// The largest that this joint's motor can take [A].
inline double possibleCurrent(const Parameters& parameters) noexcept
{
  constexpr double MARGIN = 3.0;  // of a current's peaks over the motor's continuous torque [-]
  return MARGIN * parameters.motor.torque_limit * nominalRatio(parameters.gear) /
         parameters.telemetry.torque_per_current;
}
}  // namespace hjt
