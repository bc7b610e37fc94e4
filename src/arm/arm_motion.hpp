// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/arm_dynamics.hpp"

namespace hjt
{
/// All joints of an arm at one time of a commanded motion.
struct ArmSetPoint
{
  double time{};                    ///< time on the time axis of the motion [s]
  std::vector<JointMotion> joints;  ///< angle, speed and acceleration of each joint
};

/// Source of the accelerations between two set points.
enum class ArmAccelerations : std::uint8_t
{
  GIVEN,     ///< linear between the accelerations of the set points, for set points that lie close together
  OF_CUBICS  ///< second derivatives of the cubics, whatever accelerations the set points have
};

/// A commanded motion through set points. Between two set points the angles follow cubics that have the angles and
/// speeds of both set points. Before the first set point, and after the last one, the joints stand still at the angles
/// of this set point.
class ArmMotion
{
public:
  /// `points`: at least one set point, in the order of time. `repeats`: whether the motion begins again after the last
  /// set point, which must have the same angles as the first one.
  explicit ArmMotion(std::vector<ArmSetPoint> points, ArmAccelerations accelerations = ArmAccelerations::GIVEN,
                     bool repeats = false)
    : points_(std::move(points)), accelerations_(accelerations), repeats_(repeats)
  {
  }

  double begin() const noexcept { return points_.front().time; }  ///< time of the first set point [s]
  double end() const noexcept { return points_.back().time; }     ///< time of the last set point [s]
  std::size_t joints() const noexcept { return points_.front().joints.size(); }
  const std::vector<ArmSetPoint>& points() const noexcept { return points_; }

  /// Computes the motion of each joint at a time [s], fastest if times increase. `motion` has an entry for each joint.
  void at(double time, std::vector<JointMotion>& motion) noexcept;

  /// Adds a set point to a motion of two set points: the second set point becomes the first, and the new one the
  /// second. A set point at the time of the second one only replaces the second. The new set point need not be at rest.
  void goOn(double time, const std::vector<JointMotion>& joints) noexcept;

  /// Replaces angle, speed and acceleration of each joint at the first set point. `joints` has an entry for each joint.
  void beginFrom(const std::vector<JointMotion>& joints) noexcept { points_.front().joints = joints; }

private:
  std::vector<ArmSetPoint> points_;
  ArmAccelerations accelerations_;
  bool repeats_;
  bool goes_on_{};      // whether goOn() adds the set points one by one
  std::size_t last_{};  // index of the set point before the time of the last call of at()
};

/// Set points that lead from rest to `point` (fromRest), or from `point` to rest (toRest), including `point`. If the
/// joints rest at `point`, `point` is the only set point.
std::vector<ArmSetPoint> fromRest(const ArmSetPoint& point);
std::vector<ArmSetPoint> toRest(const ArmSetPoint& point);

/// A gentle motion of all joints that repeats without end, at three speeds, in both directions. The middle pose is that
/// in which the check-up of the second joint begins. An arm without ArmJoint::check_up or without limits stands still
/// at angles of 0. @throws ParameterError if the motion would exceed a limit.
ArmMotion gentleMotion(const ArmDescription& arm);

/// Move of all joints together, as by URScript's movej. Without a limit of the jerk the speed over time is a trapezoid.
/// With a limit the speed is the moving mean of this trapezoid over the time in which the acceleration rises.
struct ArmMove
{
  std::vector<double> target;  ///< angles of all joints after the move [rad]
  double speed{};              ///< largest speed of the joint that moves farthest [rad/s]
  double acceleration{};       ///< largest acceleration of the joint that moves farthest [rad/s^2]
  double jerk{};               ///< largest jerk of the joint that moves farthest; 0: no limit [rad/s^3]
  double wait{};               ///< time at rest after the move [s]
};

using ArmPose = std::vector<double>;  ///< angles of all joints [rad]

/// A set point and the torques that its motion needs.
struct ArmInstant : ArmSetPoint
{
  std::vector<double> torques;  ///< load at the output of each joint at the set point [N.m]
};

/// Moves of a check-up of one joint. The joint moves alone, from ArmJoint::check_up and back to it. Slow strokes over
/// its whole range show stiffness and friction by load. Strokes through zero load show clearance and hysteresis. Fast
/// strokes are the last. @throws ParameterError if the arm's file gives no ArmJoint::check_up, or no limits of a joint.
std::vector<ArmMove> checkUpMoves(const ArmDescription& arm, std::size_t joint);

/// Samples the moves every `period` [s], with a rest before the first move and after the last one. @throws
/// ParameterError naming a joint that would exceed the limit of its speed or torque, or if the moves take too long.
std::vector<ArmInstant> sampleMoves(const ArmDescription& arm, const ArmPose& start, const std::vector<ArmMove>& moves,
                                    double period);
}  // namespace hjt
