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
  double time{};                    ///< [s]
  std::vector<JointMotion> joints;  ///< all
};

/// Accelerations between set points.
enum class ArmAccelerations : std::uint8_t
{
  GIVEN,     ///< linear between those of the set points, which lie close together
  OF_CUBICS  ///< those of the angles between them; the set points' own are not read
};

/// A commanded motion between its set points: angles by cubics that have the set points' angles and speeds. Before the
/// first and after the last it stands still there.
class ArmMotion
{
public:
  /// At least one set point, in order of time; otherwise undefined. `repeats`: after the last it goes on from the
  /// first, which then has the same angles.
  explicit ArmMotion(std::vector<ArmSetPoint> points, ArmAccelerations accelerations = ArmAccelerations::GIVEN,
                     bool repeats = false)
    : points_(std::move(points)), accelerations_(accelerations), repeats_(repeats)
  {
  }

  double begin() const noexcept { return points_.front().time; }  ///< [s]
  double end() const noexcept { return points_.back().time; }     ///< [s]
  std::size_t joints() const noexcept { return points_.front().joints.size(); }
  const std::vector<ArmSetPoint>& points() const noexcept { return points_; }

  /// Fast for times that go forward; `motion`: of the joints' size.
  void at(double time, std::vector<JointMotion>& motion) noexcept;

  /// This set point follows the last in place of the first of two; the motion need not end there at rest.
  void goOn(double time, const std::vector<JointMotion>& joints) noexcept;

  /// The first set point becomes this one, of as many joints.
  void beginFrom(const std::vector<JointMotion>& joints) noexcept { points_.front().joints = joints; }

private:
  std::vector<ArmSetPoint> points_;
  ArmAccelerations accelerations_;
  bool repeats_;
  bool goes_on_{};      // set points follow one by one
  std::size_t last_{};  // set point not after the time asked for last
};

/// Set points from rest to this one, which is the last, or from it to rest; it alone where it is at rest.
std::vector<ArmSetPoint> fromRest(const ArmSetPoint& point);
std::vector<ArmSetPoint> toRest(const ArmSetPoint& point);

/// A gentle motion of all joints that comes back to where it began, again and again: slow and fast, each joint both
/// ways. About the pose in which the arm stands upright for its check-up. An arm without ArmJoint::check_up or limits
/// stands still at angles of 0. @throws ParameterError if it would go beyond a limit.
ArmMotion gentleMotion(const ArmDescription& arm);

/// Straight move of all joints together, the speed over time a trapezoid, as URScript's movej; with a limit of the jerk
/// that trapezoid's mean over the time in which the acceleration comes.
struct ArmMove
{
  std::vector<double> target;  ///< angles of all joints [rad]
  double speed{};              ///< of the joint that goes farthest, at most [rad/s]
  double acceleration{};       ///< largest of that joint [rad/s^2]
  double jerk{};               ///< largest of that joint; 0: no limit [rad/s^3]
  double wait{};               ///< at rest afterwards [s]
};

/// Joint angles before the first move [rad].
using ArmPose = std::vector<double>;

/// An arm at one time of a motion.
struct ArmInstant
{
  double time{};                    ///< [s]
  std::vector<JointMotion> joints;  ///< all
  std::vector<double> torques;      ///< that make the motion, at the outputs [N.m]
};

/// The motion in which a joint's faults are looked for: slow one way and the other over all of its stroke, for
/// stiffness and friction by load; to and fro where the load goes through zero, for clearance and loop; fast. The joint
/// moves alone, from ArmJoint::check_up and back to it. @throws ParameterError if the arm's file gives no such pose, or
/// no limits of a joint.
std::vector<ArmMove> checkUpMoves(const ArmDescription& arm, std::size_t joint);

/// The moves at the times k `period` [s], at rest before and after. @throws ParameterError naming the joint that goes
/// beyond the limit of its speed or its torque, if it has one, and if it takes too long to be kept.
std::vector<ArmInstant> sampleMoves(const ArmDescription& arm, const ArmPose& start, const std::vector<ArmMove>& moves,
                                    double period);
}  // namespace hjt
