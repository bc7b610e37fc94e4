// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "arm/arm_controller.hpp"
#include "arm/arm_motion.hpp"
#include "arm/arm_twin.hpp"

namespace hjt
{
/// State of a joint as the arm's controller reports it.
struct JointReading
{
  double position{};  ///< angle by the encoder at the output [rad]
  double velocity{};  ///< speed by the encoder at the motor, over the ratio, that the current was computed from [rad/s]
  double current{};   ///< current of the motor [A]
};

/// A motion that the arm's controller ended by itself.
struct ProtectiveStop
{
  Stamp stamp{};         ///< stamp at which the controller stopped the arm
  std::size_t joint{};   ///< number of the joint, from the base on
  const char* reason{};  ///< reason in words
};

/// A twin of an arm that follows set points under its controller. After a reset the arm stands in its brakes for half
/// of the settling time, and the controller holds it for the other half. Then its motion begins. A motion that does not
/// begin at rest gets a lead-in.
///
/// Where a joint is STOP_DEVIATION off its set point, or faster than STOP_SPEED times its limit, the controller makes a
/// protective stop: the motors give no torque and the brakes engage until the arm is unlocked or reset. The two bounds
/// are assumed, because the maker gives none.
///
/// After construction only a copy throws or allocates.
class MovingArm
{
public:
  static constexpr double CONTROL_RATE = 2000.0;  ///< rate of the controller [Hz]
  static constexpr double SETTLING = 0.5;         ///< settling time if no other is given [s]
  static constexpr double STOP_DEVIATION = 0.1;   ///< deviation from the set point that stops the arm [rad]
  static constexpr double STOP_SPEED = 1.1;       ///< speed over ArmJoint::speed_limit that stops the arm [-]
  static constexpr double STILL = 0.1;            ///< largest speed of a joint at which the arm is unlocked [rad/s]

  /// `drives`: as ArmTwin takes them. The onsets of their faults count from the begin of the motion, but faults with an
  /// onset of 0 exist from the reset on. `settling` is 0 or more [s]. @throws ParameterError.
  MovingArm(const ArmDescription& arm, const std::vector<Parameters>& drives, ArmMotion motion,
            const SurfaceSource& surface_source, double settling = SETTLING);

  /// Sets the arm back to the start of the motion that was given at construction. Returns false as ArmTwin::reset.
  bool reset(Stamp stamp) noexcept;

  /// Makes a step as ArmTwin::step, with the commands of the controller.
  bool step(Stamp until) noexcept;

  /// Takes another motion, in exchange for the last one that was taken so. The motion begins now, from the present set
  /// point, which replaces its first one.
  void follow(ArmMotion& motion) noexcept;

  /// Time until the end of the commanded motion; it is negative after the end [s].
  double commandLeft() const noexcept
  {
    return commanded_.end() - commanded_.begin() - toSeconds(twin_.stamp() - command_begin_);
  }

  /// Goes on to a set point that is due at `time`, for a motion that comes point by point. The motion given at
  /// construction must have two set points, of which the first is the start. `time` is a time of that motion, later
  /// than the last one.
  void goOn(double time, const std::vector<JointMotion>& set_point) noexcept { motion_.goOn(time, set_point); }

  /// Sets the payload at the tip, from the next step on. The controller knows the payload.
  void setPayload(const Payload& payload) noexcept;

  /// Gives the present set point. `motion` has an entry for each joint.
  void wanted(std::vector<JointMotion>& motion) noexcept { wantedAt(twin_.stamp(), motion); }

  /// Ends a protective stop: the controller holds the arm where it stands until the next motion. Returns false, and the
  /// arm stays stopped, if a joint still moves.
  bool unlock() noexcept;

  /// The protective stop of the arm; none if it is not stopped.
  const std::optional<ProtectiveStop>& protectiveStop() const noexcept { return stop_; }

  JointReading reading(std::size_t joint) const noexcept;
  Stamp motionBegin() const noexcept { return motion_begin_; }  ///< begin of the motion given at construction [ns]
  ArmTwin& twin() noexcept { return twin_; }
  const ArmTwin& twin() const noexcept { return twin_; }
  const ArmController& controller() const noexcept { return controller_; }

private:
  double leadIn() const noexcept { return lead_in_.end() - lead_in_.begin(); }  // [s]
  void control() noexcept;
  void watch() noexcept;
  void wantedAt(Stamp stamp, std::vector<JointMotion>& motion) noexcept;

  double settling_;    // settling time [s]
  ArmMotion lead_in_;  // ends where the motion begins
  ArmTwin twin_;
  ArmController controller_;
  ArmMotion motion_;
  double motion_start_;  // time of the first set point of motion_ [s]
  ArmMotion commanded_;
  bool is_commanded_{};
  Stamp motion_begin_{};
  Stamp command_begin_{};
  std::vector<JointMotion> set_point_;  // set point of the last control
  std::vector<double> fastest_;         // speeds of the joints above which the arm is stopped [rad/s]
  std::optional<ProtectiveStop> stop_;
  bool is_held_{};  // the arm is held at the last set point, after a stop
};
}  // namespace hjt
