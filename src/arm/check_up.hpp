// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/arm_dynamics.hpp"

namespace hjt
{
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
