// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_description.hpp"

namespace hjt
{
/// A joint at one row of its controller's recording. Errors: target less actual, the target as old as the actual value.
struct ControllerRow
{
  double angle_error{};     ///< [rad]
  double speed_error{};     ///< [rad/s]
  double speed{};           ///< target [rad/s]
  double rigid_current{};   ///< of the rigid-body torque, by the gain [A]
  double target_current{};  ///< with the friction that is fed forward [A]
  double current{};         ///< actual [A]
};

/// Gains of a joint's controller, identified.
struct ControllerFit
{
  double angle_current{};        ///< current for an error of the angle [A/rad]
  double angle_half_width{};     ///< 95 % [A/rad]
  double speed_current{};        ///< current for an error of the speed [A.s/rad]
  double speed_half_width{};     ///< 95 % [A.s/rad]
  double position_half_width{};  ///< 95 %, of the gain of the angle [1/s]
  double lag{};                  ///< of the recorded current behind the errors [s]
  double explained{};  ///< share of the current's variance beside the rigid-body torque's, swings shorter than 1 s
  JointGains gains;
  std::string refusal;  ///< why they stay as they were; empty: they do not
};

/// Least squares of
///
///   i - i_rigid = a e(t - lag) + b de(t - lag) + c integral e + d sign v + f v + g i_rigid
///
/// each less its mean over a second about the row; the lag is the one that leaves least. With k_v = b K, K the torque
/// per current, a / b = k_p + 1 / T_i of ArmController: friction, of the same slow swings, hides the integral's time,
/// which stays that of `usual`, or 2 b / a where the sum is less than twice its inverse. Friction that is fed forward:
/// target current less that of the rigid-body torque. Left out is what lies within a quarter of a second of a jump of
/// the set point's speed, or of a current that stands at the `feedback_limit` (ArmJoint): there the control is not
/// linear, and the errors are so large that they alone would count. `period`: of the rows [s].
ControllerFit fitController(const std::vector<ControllerRow>& rows, double period, double torque_per_current,
                            const JointGains& usual, double feedback_limit);
}  // namespace hjt
