// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/arm_twin.hpp"

namespace hjt
{
/// Cascaded control of an arm's joints, as in UR's: the angle by the encoder at the output, the speed by that at the
/// motor, the current's torque; rigid-body torque and friction of the set point fed forward.
///
///   v_c = v_s + k_p (q_s - q)      q by the output's encoder, v by the motor's, over the ratio
///   T   = T_s + c,  c = k_v (v_c - v) + k_v / T_i integral (v_c' - v)
///
/// At an instant t of the control q and v are what the sensors read there, and T holds from t on; q_s and T_s are those
/// of the set point of t - ArmJoint::delay, v_s that of half of sensors.velocity_window earlier, as the speed v is.
/// v_c' is v_c for what is left of q_s - q beyond a count of the coarser encoder, seen at the joint: at rest within it
/// the torque stands.
///
/// c stays within ArmJoint::feedback_limit, T within the motor's. The integral stands while one of them is beyond, and
/// while the brake is engaged.
class ArmController
{
public:
  /// Of the motor, seen from the joint [kg.m^2].
  static double motorInertia(const Parameters& drive);

  /// For a drive without gains of its own: speed control of 25 Hz on the motor, position of 3 Hz, no friction.
  static JointGains defaultGains(const Parameters& drive);

  /// `rate`: of the control [Hz], a divisor of solver.rate.
  ArmController(const ArmDescription& arm, const ArmTwin& twin, std::vector<JointGains> gains, double rate);

  void reset() noexcept;                                                               ///< forgets integrals and count
  void setPayload(const Payload& payload) noexcept { dynamics_.setPayload(payload); }  ///< that it feeds forward

  /// To be called at each instant that is due, with its set point: commands each drive from there on.
  void control(ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept;

  bool isDue(const ArmTwin& twin) const noexcept;  ///< the present instant is one of the control

  /// Torque fed forward for the last set point, which acts after the delay: rigid-body, and with friction [N.m].
  const std::vector<double>& rigidTorques() const noexcept { return rigid_; }
  /// How often a joint's feedback was at its limit while its brake was off, since reset [-].
  std::uint64_t limitedControls() const noexcept { return limited_; }
  double feedForward(std::size_t joint) const noexcept { return feed_forward_[joint]; }
  /// Of a joint by the motor's encoder: while it controls the one that the torque until now was made of, else the
  /// present [rad/s].
  double speed(const ArmTwin& twin, std::size_t joint) const noexcept;

private:
  static constexpr Stamp NEVER = std::numeric_limits<Stamp>::min() / 2;

  /// A set point of a joint on its way to the control.
  struct Wanted
  {
    double position{};  // [rad]
    double velocity{};  // [rad/s]
    double torque{};    // fed forward [N.m]
  };

  void take(const ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept;
  Wanted delayed(std::size_t joint, double periods) const noexcept;

  ArmDynamics dynamics_;
  std::vector<JointGains> gains_;
  std::vector<double> feedback_limit_;  // HUGE_VAL: none [N.m]
  std::vector<double> delay_;           // of the set points [periods]
  std::vector<double> speed_delay_;     // of their speeds [periods]
  std::vector<double> unseen_;          // error of the angle that the integral leaves [rad]
  Stamp period_;
  std::vector<std::vector<Wanted>> line_;  // of each joint, a ring of the last
  std::size_t newest_{};                   // in it
  std::vector<double> rigid_;
  std::vector<double> feed_forward_;
  std::vector<double> integral_;  // of the torque [N.m]
  std::vector<double> speed_;     // of the joints at the last control [rad/s]
  std::vector<double> before_;    // and at the one before [rad/s]
  Stamp controlled_{ NEVER };     // the last one
  std::uint64_t limited_{};       // controls of a joint [-]
};
}  // namespace hjt
