// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Motor current of 1 of what a robot gives as effort [A], [A/(N.m)].
inline double currentPerEffort(EffortUnit effort, const Parameters& parameters) noexcept
{
  const double gain = parameters.telemetry.torque_per_current;
  switch (effort)
  {
    case EffortUnit::CURRENT:
      break;
    case EffortUnit::JOINT_TORQUE:
      return 1.0 / gain;
    case EffortUnit::MOTOR_TORQUE:
      return nominalRatio(parameters.gear) / gain;
  }
  return 1.0;
}

/// Current per effort in the configured unit.
inline double currentPerEffort(const Parameters& parameters) noexcept
{
  return currentPerEffort(parameters.telemetry.effort, parameters);
}
}  // namespace hjt
