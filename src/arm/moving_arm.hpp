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
  double velocity{};  ///< speed by the motor's encoder / ratio, from which the controller computed the torque [rad/s]
  double current{};   ///< current of the motor [A]
};

/// A stop of the arm by its controller.
struct ProtectiveStop
{
  Stamp stamp{};         ///< stamp at which the controller stopped the arm
  std::size_t joint{};   ///< number of the joint, from the base on
  const char* reason{};  ///< reason in words, for example "off its set point"
};

/// A twin of an arm that follows set points under its controller. After a reset the brakes hold the arm for half of the
/// settling time, and the controller holds the arm for the other half. Then the motion begins. If the joints move at
/// the first set point, the arm accelerates from rest to this set point in a lead-in before the motion.
///
/// If a joint is more than STOP_DEVIATION away from its set point, or faster than STOP_SPEED times its speed limit, the
/// controller makes a protective stop: the motors have no torque, and the brakes hold the arm until unlock() or
/// reset(). STOP_DEVIATION and STOP_SPEED are assumptions, because the maker publishes no values.
///
/// After construction only a copy throws or allocates.
class MovingArm
{
public:
  static constexpr double CONTROL_RATE = 2000.0;  ///< rate of the controller [Hz]
  static constexpr double SETTLING = 0.5;         ///< settling time if no other is given [s]
  static constexpr double STOP_DEVIATION = 0.1;   ///< deviation from a joint's set point that stops the arm [rad]
  static constexpr double STOP_SPEED = 1.1;       ///< speed over ArmJoint::speed_limit from which on the arm stops [-]
  static constexpr double STILL = 0.1;            ///< largest speed of a joint at which unlock() works [rad/s]

  /// `drives`: as in the constructor of ArmTwin. The onsets of faults count from the beginning of the motion, but
  /// faults with an onset of 0 exist from the reset on. `settling`: 0 or more [s]. @throws ParameterError.
  MovingArm(const ArmDescription& arm, const std::vector<Parameters>& drives, ArmMotion motion,
            const SurfaceSource& surface_source, double settling = SETTLING);

  /// Sets the arm back to the start of the motion given at construction. Returns false if ArmTwin::reset() does.
  bool reset(Stamp stamp) noexcept;

  /// Makes one step of the twin under the controller. Returns as ArmTwin::step() does.
  bool step(Stamp until) noexcept;

  /// Begins another motion now, from the present set point, which replaces the first set point of `motion`. The
  /// function swaps `motion` with the motion of the last call, so that the call releases no memory.
  void follow(ArmMotion& motion) noexcept;

  /// Time until the end of the motion given to follow(); negative after the end [s].
  double commandLeft() const noexcept
  {
    return commanded_.end() - commanded_.begin() - toSeconds(twin_.stamp() - command_begin_);
  }

  /// Adds a set point to a motion that receives its set points one by one. The motion given at construction must have
  /// two set points, the start first. `time` [s] is on the time axis of that motion and never decreases from call to
  /// call. A set point at the time of the last one replaces the last one.
  void goOn(double time, const std::vector<JointMotion>& set_point) noexcept { motion_.goOn(time, set_point); }

  /// Sets the payload at the tip, from the next step on. The controller feeds forward the torque of this payload.
  void setPayload(const Payload& payload) noexcept;

  /// Gives the present set point of each joint. `motion` has an entry for each joint.
  void wanted(std::vector<JointMotion>& motion) noexcept { wantedAt(twin_.stamp(), motion); }

  /// Ends a protective stop. The controller then holds the arm in its present pose until the next motion. If a joint
  /// still moves, the function does nothing and returns false.
  bool unlock() noexcept;

  /// The present protective stop; none: the controller has not stopped the arm.
  const std::optional<ProtectiveStop>& protectiveStop() const noexcept { return stop_; }

  JointReading reading(std::size_t joint) const noexcept;
  Stamp motionBegin() const noexcept { return motion_begin_; }  ///< stamp of the motion's start [ns]
  ArmTwin& twin() noexcept { return twin_; }
  const ArmTwin& twin() const noexcept { return twin_; }
  const ArmController& controller() const noexcept { return controller_; }

private:
  double leadIn() const noexcept { return lead_in_.end() - lead_in_.begin(); }  // duration of the lead-in [s]
  void control() noexcept;
  void watch() noexcept;
  void wantedAt(Stamp stamp, std::vector<JointMotion>& motion) noexcept;

  double settling_;    // time from a reset to the lead-in [s]
  ArmMotion lead_in_;  // motion from rest to the first set point; empty if the first set point is at rest
  ArmTwin twin_;
  ArmController controller_;
  ArmMotion motion_;
  double motion_start_;  // time of the first set point of motion_ [s]
  ArmMotion commanded_;
  bool is_commanded_{};
  Stamp motion_begin_{};
  Stamp command_begin_{};
  std::vector<JointMotion> set_point_;  // set point of each joint at the last call of control()
  std::vector<double> fastest_;         // speed of each joint above which the arm stops [rad/s]
  std::optional<ProtectiveStop> stop_;
  bool is_held_{};  // true: after unlock() the controller holds the arm at the last set point
};
}  // namespace hjt
