// SPDX-License-Identifier: BSD-3-Clause
#include "arm/recording_units.hpp"

#include <algorithm>

#include "params/choices.hpp"

namespace hjt
{
double likelyTimeScale(double period)
{
  constexpr double FASTEST_ROWS = 0.5e-3;  // [s]
  constexpr double LONG = 0.5;             // no telemetry comes so rarely [s]
  if (period < LONG)
  {
    return 1.0;
  }
  double scale = 1e-3;
  while (scale * period > SLOW_ROWS)
  {
    scale *= 1e-3;
  }
  return scale * period > FASTEST_ROWS ? scale : 1.0;
}

const char* effortUnitName(EffortUnit unit)
{
  switch (unit)
  {
    case EffortUnit::CURRENT:
      break;
    case EffortUnit::JOINT_TORQUE:
      return "a torque at the joint in N.m";
    case EffortUnit::MOTOR_TORQUE:
      return "a torque of the motor in N.m";
  }
  return "the motor's current in A";
}

const char* effortKeyword(EffortUnit unit)
{
  const auto names = choiceNames(unit);
  return std::find_if(names.begin(), names.end(), [&](const auto& name) { return name.second == unit; })->first;
}
}  // namespace hjt
