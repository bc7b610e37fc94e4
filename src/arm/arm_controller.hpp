// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/arm_twin.hpp"

namespace hjt
{
/// Cascaded control of an arm's joints, as UR's controller has it. The outer loop controls the angle of the encoder at
/// the output, the inner loop the speed of the encoder at the motor. The rigid-body torque and the friction of the set
/// point are fed forward.
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
  /// Inertia of the motor, seen from the joint [kg.m^2].
  static double motorInertia(const Parameters& drive);

  /// Gains for a drive that has none of its own: a bandwidth of 25 Hz of the speed control and of 3 Hz of the position
  /// control, and no friction fed forward.
  static JointGains defaultGains(const Parameters& drive);

  /// `rate` of the control must divide solver.rate [Hz].
  ArmController(const ArmDescription& arm, const ArmTwin& twin, std::vector<JointGains> gains, double rate);

  void reset() noexcept;  ///< sets integrals and counter to zero
  void setPayload(const Payload& payload) noexcept
  {
    dynamics_.setPayload(payload);
  }  ///< payload whose torque is fed forward

  /// Commands the torque of each drive from now on. To be called at each instant for which isDue() is true, with the
  /// set point of that instant.
  void control(ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept;

  bool isDue(const ArmTwin& twin) const noexcept;  ///< whether the control acts at the present instant

  /// Rigid-body torque of each joint that is fed forward for the last set point; it acts after the delay [N.m].
  const std::vector<double>& rigidTorques() const noexcept { return rigid_; }
  /// How often a joint's feedback was at its limit while its brake was off, since reset [-].
  std::uint64_t limitedControls() const noexcept { return limited_; }
  /// The whole torque of a joint that is fed forward, with inertia of the motor and friction [N.m].
  double feedForward(std::size_t joint) const noexcept { return feed_forward_[joint]; }
  /// Speed of a joint by the motor's encoder. While the controller runs, the speed that the present torque was computed
  /// from, else the present speed [rad/s].
  double speed(const ArmTwin& twin, std::size_t joint) const noexcept;

private:
  static constexpr Stamp NEVER = std::numeric_limits<Stamp>::min() / 2;

  /// A set point of a joint on its way to the control.
  struct Wanted
  {
    double position{};  // wanted angle [rad]
    double velocity{};  // wanted speed [rad/s]
    double torque{};    // torque that is fed forward [N.m]
  };

  void take(const ArmTwin& twin, const std::vector<JointMotion>& set_point) noexcept;
  Wanted delayed(std::size_t joint, double periods) const noexcept;

  ArmDynamics dynamics_;
  std::vector<JointGains> gains_;
  std::vector<double> feedback_limit_;  // limit of each joint's feedback torque, HUGE_VAL without a limit [N.m]
  std::vector<double> delay_;           // delays of the set points [periods]
  std::vector<double> speed_delay_;     // delays of the set points' speeds [periods]
  std::vector<double> unseen_;          // errors of the angle below which the integral stands [rad]
  Stamp period_;
  std::vector<std::vector<Wanted>> line_;  // the last set points of each joint, as a ring
  std::size_t newest_{};                   // place of the newest set point in line_
  std::vector<double> rigid_;
  std::vector<double> feed_forward_;
  std::vector<double> integral_;  // integral parts of the torques [N.m]
  std::vector<double> speed_;     // speeds of the joints at the last control [rad/s]
  std::vector<double> before_;    // speeds of the joints at the control before the last [rad/s]
  Stamp controlled_{ NEVER };     // stamp of the last control
  std::uint64_t limited_{};       // number of controls with a limited feedback [-]
};
}  // namespace hjt
