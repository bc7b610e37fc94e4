// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tracking/tracker.hpp"

namespace hjt
{
/// Measured values of a joint and predicted values of a sound joint. Comparison.msg has the same names.
struct ComparisonRow
{
  double time;
  double position_measured;
  double position_predicted;
  double position_residual;
  double position_band;
  double velocity_measured;
  double velocity_predicted;
  double velocity_residual;
  double current_measured;
  double current_predicted;
  double current_residual;
  double current_band;
  double residual_torque;
  double joint_torque;
  double friction_torque;
  double load_torque;
  double temperature;
  double housing_temperature;
  bool load_told;
  bool temperature_received;
  bool sticking;
  bool after_gap;
  bool outside_band;
};

inline ComparisonRow rowOf(const Comparison& now) noexcept
{
  return { now.time,
           now.position.measured,
           now.position.predicted,
           now.position.residual(),
           now.position.band,
           now.velocity.measured,
           now.velocity.predicted,
           now.velocity.residual(),
           now.current.measured,
           now.current.predicted,
           now.current.residual(),
           now.current.band,
           now.residual_torque,
           now.joint_torque,
           now.friction_torque,
           now.load_torque,
           now.temperature,
           now.housing_temperature,
           now.load_provided,
           now.temperature_received,
           now.sticking,
           now.after_gap,
           now.isOutside() };
}
}  // namespace hjt
