// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// A health indicator that may not be valid. Its value is then 0.
struct Indicator
{
  bool valid{};
  double value{};
};

/// Indicators that follow from the motion.
struct MotionIndicators
{
  Indicator transmission_ratio;   ///< over the last motor turn [-]
  double torsion{};               ///< motor angle / nominal ratio - output angle [rad]
  Indicator torsional_stiffness;  ///< [N.m/rad]
  Indicator efficiency;           ///< [-]
  Indicator kinematic_error;      ///< peak to peak over the last motor turn [rad]
};
}  // namespace hjt
