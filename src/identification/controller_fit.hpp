// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_description.hpp"

namespace hjt
{
/// One row of a recording, for the fit of a joint's controller. Errors are target minus actual value at the same time.
struct ControllerRow
{
  double angle_error{};     ///< error of the angle [rad]
  double speed_error{};     ///< error of the speed [rad/s]
  double speed{};           ///< target speed [rad/s]
  double rigid_current{};   ///< rigid-body torque divided by the torque per current [A]
  double target_current{};  ///< target current, including the current for the fed-forward friction [A]
  double current{};         ///< actual current [A]
};

/// Identified gains of a joint's controller, with intervals.
struct ControllerFit
{
  double angle_current{};        ///< current per error of the angle [A/rad]
  double angle_half_width{};     ///< half width of the 95 % interval of `angle_current` [A/rad]
  double speed_current{};        ///< current per error of the speed [A.s/rad]
  double speed_half_width{};     ///< half width of the 95 % interval of `speed_current` [A.s/rad]
  double position_half_width{};  ///< half width of the 95 % interval of angle_current / speed_current [1/s]
  double lag{};                  ///< lag of the recorded current behind the errors [s]
  /// Share of the variance of current minus rigid_current, for periods below 1 s, that the fit explains [-].
  double explained{};
  JointGains gains;
  std::string refusal;  ///< reason why the gains were not identified; empty if they were identified
};

/// Least-squares fit of the equation
///
///   i - i_rigid = a e(t - lag) + b de(t - lag) + c integral e + d sign v + f v + g i_rigid
///
/// with a to g the fitted coefficients, i the actual current, i_rigid that of the rigid-body torque, e and de the
/// errors of angle and speed, and v the target speed. A moving mean over a second is subtracted from each term. The lag
/// with the smallest residual counts. With k_v = b K and K the torque per current, a / b = k_p + 1 / T_i of
/// ArmController. Slow motion does not separate the integral from friction. So T_i is that of `usual`, or 2 b / a if a
/// / b is less than 2 / T_i. The fed-forward friction is the target current minus i_rigid. The fit excludes a quarter
/// of a second before and after each jump of the target speed and each current at the `feedback_limit` (ArmJoint).
/// There the control is not linear, and large errors would dominate. `period`: time between two rows [s].
ControllerFit fitController(const std::vector<ControllerRow>& rows, double period, double torque_per_current,
                            const JointGains& usual, double feedback_limit);
}  // namespace hjt
