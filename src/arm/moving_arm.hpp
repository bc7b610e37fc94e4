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
  double position{};  ///< by the encoder at the output [rad]
  double velocity{};  ///< by that at the motor, over the ratio, that the current was made of [rad/s]
  double current{};   ///< of the motor [A]
};

/// A motion that the arm's controller ended by itself.
struct ProtectiveStop
{
  Stamp stamp{};         ///< when it was seen
  std::size_t joint{};   ///< of the arm, from the base on
  const char* reason{};  ///< for people
};

/// A twin of an arm under its controller, which has it follow set points. After a reset it stands in its brakes for
/// half of the settling, is held where it stands for the other half, then begins its motion; to one that begins in
/// motion it comes by a lead-in.
///
/// Where a joint is STOP_DEVIATION off its set point, or faster than STOP_SPEED of its limit, the controller stops all:
/// the motors give no torque, the brakes engage, until it is unlocked or reset. The bounds are assumed; the maker gives
/// none.
///
/// After construction nothing but a copy throws or allocates.
class MovingArm
{
public:
  static constexpr double CONTROL_RATE = 2000.0;  ///< [Hz]
  static constexpr double SETTLING = 0.5;         ///< if no other is given [s]
  static constexpr double STOP_DEVIATION = 0.1;   ///< [rad]
  static constexpr double STOP_SPEED = 1.1;       ///< of ArmJoint::speed_limit [-]
  static constexpr double STILL = 0.1;            ///< speed of a joint that may be unlocked [rad/s]

  /// `drives`: as ArmTwin takes them; the onsets of their faults count from the motion's begin, but those at 0 are
  /// there from the reset on. settling: from 0 on [s]. @throws ParameterError.
  MovingArm(const ArmDescription& arm, const std::vector<Parameters>& drives, ArmMotion motion,
            const SurfaceSource& surface_source, double settling = SETTLING);

  /// Back to the start of the motion given at construction. False: as ArmTwin::reset.
  bool reset(Stamp stamp) noexcept;

  /// As ArmTwin::step, with what the controller commands.
  bool step(Stamp until) noexcept;

  /// Gets another motion in exchange for the last one taken this way. It begins now, from the present set point, which
  /// takes the place of its first.
  void follow(ArmMotion& motion) noexcept;

  /// Of the motion that it follows: time until its end, < 0 behind it [s].
  double commandLeft() const noexcept
  {
    return commanded_.end() - commanded_.begin() - toSeconds(twin_.stamp() - command_begin_);
  }

  /// For a motion that comes point by point: goes from the last set point to this one, which is due at `time` of the
  /// motion given at construction, later than the last. That motion has two set points; the first is the start.
  void goOn(double time, const std::vector<JointMotion>& set_point) noexcept { motion_.goOn(time, set_point); }

  /// At the tip, from the next step on; the controller knows of it.
  void setPayload(const Payload& payload) noexcept;

  /// Present set point; `motion`: of the joints' size.
  void wanted(std::vector<JointMotion>& motion) noexcept { wantedAt(twin_.stamp(), motion); }

  /// Ends a protective stop: the arm is held where it stands, until the next motion. False: a joint still moves, it
  /// stays stopped.
  bool unlock() noexcept;

  /// None: it moves.
  const std::optional<ProtectiveStop>& protectiveStop() const noexcept { return stop_; }

  JointReading reading(std::size_t joint) const noexcept;
  Stamp motionBegin() const noexcept { return motion_begin_; }  ///< of the motion given at construction [ns]
  ArmTwin& twin() noexcept { return twin_; }
  const ArmTwin& twin() const noexcept { return twin_; }
  const ArmController& controller() const noexcept { return controller_; }

private:
  double leadIn() const noexcept { return lead_in_.end() - lead_in_.begin(); }  // [s]
  void control() noexcept;
  void watch() noexcept;
  void wantedAt(Stamp stamp, std::vector<JointMotion>& motion) noexcept;

  double settling_;    // [s]
  ArmMotion lead_in_;  // ends where the motion begins
  ArmTwin twin_;
  ArmController controller_;
  ArmMotion motion_;
  double motion_start_;  // of its times [s]
  ArmMotion commanded_;
  bool is_commanded_{};
  Stamp motion_begin_{};
  Stamp command_begin_{};
  std::vector<JointMotion> set_point_;  // of the last control
  std::vector<double> fastest_;         // at which the joints are stopped [rad/s]
  std::optional<ProtectiveStop> stop_;
  bool is_held_{};  // where the last set point is, after a stop
};
}  // namespace hjt
