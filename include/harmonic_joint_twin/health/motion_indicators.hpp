// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/health/indicator.hpp"

namespace hjt
{
/// Indicators that follow from the motion of motor and output.
struct MotionIndicators
{
  Indicator transmission_ratio;   ///< over the last motor turn [-]
  double torsion{};               ///< motor angle / nominal ratio - output angle [rad]
  Indicator torsional_stiffness;  ///< [N.m/rad]
  Indicator efficiency;           ///< [-]
  Indicator kinematic_error;      ///< peak to peak over the last motor turn [rad]
};
}  // namespace hjt
