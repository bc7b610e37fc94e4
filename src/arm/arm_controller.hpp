// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/arm_twin.hpp"

namespace hjt
{
/// Cascaded control of an arm's joints, like that of a UR. The outer loop controls the angle of the encoder at the
/// output. The inner loop controls the speed of the encoder at the motor. The controller also feeds forward the
/// rigid-body torque and the friction of the set point.
///
///   v_c = v_s + k_p (q_s - q)
///   T   = T_s + c,  c = k_v (v_c - v) + k_v / T_i integral (v_c' - v)
/// q: angle by the output's encoder; v: speed by the motor's encoder, over the ratio; T: torque of the motor at the
/// joint; c: feedback; q_s, v_s, T_s: angle, speed and torque of the set point; k_p, k_v, T_i: JointGains.
///
/// At an instant t the controller reads q and v, and T holds from t on. q_s and T_s are those of the set point at
/// t - ArmJoint::delay. v_s is older by half of sensors.velocity_window, as v is. v_c' is v_c without the part of
/// q_s - q below one count of the coarser encoder, so that T stays constant while the joint rests within this count.
/// |c| is at most ArmJoint::feedback_limit, |T| at most the limit of the motor. The integral does not change while c or
/// T is at its limit, and while the brake is engaged.
class ArmController
{
public:
  static double motorInertia(const Parameters& drive);  ///< inertia of the motor, seen from the joint [kg.m^2]

  /// Gains for a drive to which the arm's file gives no gains. The bandwidth of the speed control is 25 Hz, that of the
  /// position control 3 Hz, and the controller feeds no friction forward.
  static JointGains defaultGains(const Parameters& drive);

  /// `rate`: rate of the control [Hz], which must divide solver.rate.
  ArmController(const ArmDescription& arm, const ArmTwin& twin, std::vector<JointGains> gains, double rate);

  void reset() noexcept;  ///< sets the integrals of all joints, their last speeds and limitedControls() to 0
  void setPayload(const Payload& payload) noexcept
  {
    dynamics_.setPayload(payload);
  }  ///< sets the payload whose torque the controller feeds forward

  /// Commands the torque of each drive from now on, by the present set point. Call this function whenever isDue() is
  /// true.
  void control(ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept;

  bool isDue(const ArmTwin& twin) const noexcept;  ///< whether a period of the control begins at the present instant

  /// Rigid-body torque of each joint for the last set point, which acts after ArmJoint::delay [N.m].
  const std::vector<double>& rigidTorques() const noexcept { return rigid_; }
  /// Number of calls of control() since the reset in which a joint's feedback was at its limit while its brake was off
  /// [-]. A call counts once for each such joint.
  std::uint64_t limitedControls() const noexcept { return limited_; }
  /// Whole torque that the controller feeds forward: rigidTorques() plus inertia of the motor and friction [N.m].
  double feedForward(std::size_t joint) const noexcept { return feed_forward_[joint]; }
  /// Speed of a joint by the motor's encoder [rad/s]. While the controller runs, this is the speed from which the
  /// controller computed the present torque; otherwise it is the present speed.
  double speed(const ArmTwin& twin, std::size_t joint) const noexcept;

private:
  static constexpr Stamp NEVER = std::numeric_limits<Stamp>::min() / 2;

  /// A set point of a joint that waits until the controller acts on it.
  struct Wanted
  {
    double position{};  // angle of the set point [rad]
    double velocity{};  // speed of the set point [rad/s]
    double torque{};    // torque that the controller feeds forward [N.m]
  };

  void take(const ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept;
  Wanted delayed(std::size_t joint, double periods) const noexcept;

  ArmDynamics dynamics_;
  std::vector<JointGains> gains_;
  std::vector<double> feedback_limit_;  // limit of each joint's feedback torque; HUGE_VAL: no limit [N.m]
  std::vector<double> delay_;           // delay of each joint's set point, in periods of the control [-]
  std::vector<double> speed_delay_;     // delay of the set point's speed, in periods of the control [-]
  std::vector<double> unseen_;          // error of each joint's angle below which the integral does not change [rad]
  Stamp period_;
  std::vector<std::vector<Wanted>> line_;  // the last set points of each joint, in a ring buffer
  std::size_t newest_{};                   // index of the newest set point in line_
  std::vector<double> rigid_;
  std::vector<double> feed_forward_;
  std::vector<double> integral_;  // integral part of each joint's torque [N.m]
  std::vector<double> speed_;     // speeds of the joints at the last call of control() [rad/s]
  std::vector<double> before_;    // speeds of the joints at the last but one call of control() [rad/s]
  Stamp controlled_{ NEVER };     // stamp of the last call of control()
  std::uint64_t limited_{};       // the value of limitedControls() [-]
};
}  // namespace hjt
