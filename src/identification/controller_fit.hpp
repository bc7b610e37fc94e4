// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_description.hpp"

namespace hjt
{
/// A row of a joint's controller in a recording. Errors are target minus actual value of the same time.
struct ControllerRow
{
  double angle_error{};     ///< error of the angle [rad]
  double speed_error{};     ///< error of the speed [rad/s]
  double speed{};           ///< target speed [rad/s]
  double rigid_current{};   ///< current of the rigid-body torque by the gain [A]
  double target_current{};  ///< target current, with the friction of the feedforward [A]
  double current{};         ///< actual current [A]
};

/// Identified gains of a joint's controller.
struct ControllerFit
{
  double angle_current{};        ///< current per error of the angle [A/rad]
  double angle_half_width{};     ///< half width of its 95 % interval [A/rad]
  double speed_current{};        ///< current per error of the speed [A.s/rad]
  double speed_half_width{};     ///< half width of its 95 % interval [A.s/rad]
  double position_half_width{};  ///< half width of the 95 % interval of the angle's gain [1/s]
  double lag{};                  ///< lag of the recorded current behind the errors [s]
  /// share that the errors explain in the variance of the current minus the rigid-body torque's, for periods below 1 s
  double explained{};
  JointGains gains;
  std::string refusal;  ///< reason why the gains were not identified; empty if they were identified
};

/// Least squares fit of
///
///   i - i_rigid = a e(t - lag) + b de(t - lag) + c integral e + d sign v + f v + g i_rigid
///
/// each minus its moving mean over a second. The lag is that of the smallest residual. With k_v = b K, K = torque per
/// current: a / b = k_p + 1 / T_i of ArmController. Slow swings do not separate the integral from friction, so its time
/// stays that of `usual`, or is 2 b / a if the sum is less than twice its inverse. Friction of the feedforward is the
/// target current minus that of the rigid-body torque. The fit excludes a quarter of a second on either side of a jump
/// of the set point's speed, or of a current at the `feedback_limit` (ArmJoint): there the control is not linear, and
/// large errors would dominate. `period`: time between two rows [s].
ControllerFit fitController(const std::vector<ControllerRow>& rows, double period, double torque_per_current,
                            const JointGains& usual, double feedback_limit);
}  // namespace hjt
