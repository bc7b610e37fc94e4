// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "arm/arm_twin.hpp"
#include "arm/joint_gains.hpp"

namespace hjt
{
/// Cascaded control of an arm's joints, as in UR's: the angle by the encoder at the output, the speed by that at the
/// motor, the current's torque; rigid-body torque and friction of the set point fed forward.
///
///   v_c = v_s + k_p (q_s - q)      q by the output's encoder, v by the motor's, over the ratio
///   T   = T_s + c,  c = k_v (v_c - v) + k_v / T_i integral (v_c - v)
///
/// c stays within ArmJoint::feedback_limit, T within the motor's. The integral stands while one of them is beyond, and
/// while the brake is engaged.
class ArmController
{
public:
  /// For a drive without gains of its own: speed control of 25 Hz on the motor, position of 3 Hz, no friction.
  static JointGains defaultGains(const Parameters& drive);

  /// `rate`: of the control [Hz], a divisor of solver.rate.
  ArmController(const ArmDescription& arm, const ArmTwin& twin, std::vector<JointGains> gains, double rate);

  void reset() noexcept;                                                               ///< forgets integrals and count
  void setPayload(const Payload& payload) noexcept { dynamics_.setPayload(payload); }  ///< that it feeds forward

  /// To be called before each step that is due: commands each drive towards the set point of the step's end.
  void control(ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept;

  bool isDue(const ArmTwin& twin) const noexcept;  ///< the next step ends at an instant of the control

  /// Torque fed forward for the last set point: rigid-body, and with friction [N.m].
  const std::vector<double>& rigidTorques() const noexcept { return rigid_; }
  /// How often a joint's feedback was at its limit while its brake was off, since reset [-].
  std::uint64_t limitedControls() const noexcept { return limited_; }
  double feedForward(std::size_t joint) const noexcept { return feed_forward_[joint]; }
  /// Of a joint by the motor's encoder: while it controls what the last control had, else the present [rad/s].
  double speed(const ArmTwin& twin, std::size_t joint) const noexcept;

private:
  static constexpr Stamp NEVER = std::numeric_limits<Stamp>::min() / 2;

  ArmDynamics dynamics_;
  std::vector<JointGains> gains_;
  std::vector<double> feedback_limit_;  // HUGE_VAL: none [N.m]
  Stamp period_;
  std::vector<double> rigid_;
  std::vector<double> feed_forward_;
  std::vector<double> integral_;  // of the torque [N.m]
  std::vector<double> speed_;     // of the joints at the last control [rad/s]
  Stamp controlled_{ NEVER };     // the last one
  std::uint64_t limited_{};       // controls of a joint [-]
};
}  // namespace hjt
