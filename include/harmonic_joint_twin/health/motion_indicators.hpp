// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Health indicator. The value is 0 if the indicator is not valid.
struct Indicator
{
  bool valid{};
  double value{};
};

/// Indicators that the twin computes in each step from the true angles and torques of its model.
struct MotionIndicators
{
  Indicator transmission_ratio;   ///< motor travel over output travel in the last turn of the motor [-]
  double torsion{};               ///< motor angle / nominal ratio - output angle [rad]
  Indicator torsional_stiffness;  ///< slope of joint torque over torsion [N.m/rad]
  Indicator efficiency;           ///< output power over input power [-]
  Indicator kinematic_error;      ///< peak to peak of the torsion in the last turn of the motor [rad]
};
}  // namespace hjt
