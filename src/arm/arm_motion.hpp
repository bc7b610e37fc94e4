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
  double time{};                    ///< time of the motion [s]
  std::vector<JointMotion> joints;  ///< motion of all joints
};

/// Accelerations between set points.
enum class ArmAccelerations : std::uint8_t
{
  GIVEN,     ///< linear between the accelerations of the set points, which lie close together
  OF_CUBICS  ///< second derivatives of the cubics; the accelerations of the set points are not read
};

/// A commanded motion between its set points: the angles follow cubics that have the set points' angles and speeds.
/// Before the first set point and after the last the joints stand still there.
class ArmMotion
{
public:
  /// `points`: at least one set point, in order of time. `repeats`: after the last set point the motion goes on from
  /// the first, which must have the same angles.
  explicit ArmMotion(std::vector<ArmSetPoint> points, ArmAccelerations accelerations = ArmAccelerations::GIVEN,
                     bool repeats = false)
    : points_(std::move(points)), accelerations_(accelerations), repeats_(repeats)
  {
  }

  double begin() const noexcept { return points_.front().time; }  ///< time of the first set point [s]
  double end() const noexcept { return points_.back().time; }     ///< time of the last set point [s]
  std::size_t joints() const noexcept { return points_.front().joints.size(); }
  const std::vector<ArmSetPoint>& points() const noexcept { return points_; }

  /// Gives the motion of each joint at a time [s]. It is fast for times that go forward. `motion` has an entry for each
  /// joint.
  void at(double time, std::vector<JointMotion>& motion) noexcept;

  /// Of two set points, replaces the first by the last and the last by this one. The motion need not end there at rest.
  void goOn(double time, const std::vector<JointMotion>& joints) noexcept;

  /// Replaces the joints of the first set point by the same number of joints.
  void beginFrom(const std::vector<JointMotion>& joints) noexcept { points_.front().joints = joints; }

private:
  std::vector<ArmSetPoint> points_;
  ArmAccelerations accelerations_;
  bool repeats_;
  bool goes_on_{};      // goOn adds the set points one by one
  std::size_t last_{};  // number of the set point before the time that at() was called with last
};

/// Set points that lead from rest to `point`, which is the last, and from `point` to rest. Where `point` is at rest it
/// is the only one.
std::vector<ArmSetPoint> fromRest(const ArmSetPoint& point);
std::vector<ArmSetPoint> toRest(const ArmSetPoint& point);

/// A gentle motion of all joints that repeats: slow and fast, each joint both ways, about the pose in which the arm
/// stands upright for its check-up. An arm without ArmJoint::check_up or limits stands still at angles of 0.
/// @throws ParameterError if the motion would go beyond a limit.
ArmMotion gentleMotion(const ArmDescription& arm);

/// Straight move of all joints together, as URScript's movej: the speed over time is a trapezoid. With a limit of the
/// jerk it is the trapezoid's moving mean over the time in which the acceleration rises.
struct ArmMove
{
  std::vector<double> target;  ///< angles of all joints [rad]
  double speed{};              ///< largest speed of the joint that goes farthest [rad/s]
  double acceleration{};       ///< largest acceleration of that joint [rad/s^2]
  double jerk{};               ///< largest jerk of that joint, 0 without a limit [rad/s^3]
  double wait{};               ///< time at rest after the move [s]
};

/// Angles of all joints [rad].
using ArmPose = std::vector<double>;

/// A set point and the torques that its motion needs.
struct ArmInstant : ArmSetPoint
{
  std::vector<double> torques;  ///< torques at the outputs that make the motion [N.m]
};

/// The motion in which a joint's faults are looked for: slow one way and the other over all of its stroke, for
/// stiffness and friction by load; to and fro where the load goes through zero, for clearance and loop; fast. The joint
/// moves alone, from ArmJoint::check_up and back to it. @throws ParameterError if the arm's file gives no such pose, or
/// no limits of a joint.
std::vector<ArmMove> checkUpMoves(const ArmDescription& arm, std::size_t joint);

/// Samples the moves every `period` [s], with a rest before and after them. @throws ParameterError naming a joint that
/// would exceed the limit of its speed or torque, or if the moves take too long.
std::vector<ArmInstant> sampleMoves(const ArmDescription& arm, const ArmPose& start, const std::vector<ArmMove>& moves,
                                    double period);
}  // namespace hjt
