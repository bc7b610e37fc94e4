// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <trajectory_msgs/JointTrajectory.h>

#include "arm/arm_motion.hpp"

namespace hjt
{
/// Converts a trajectory to set points, of which the first is the present one at time 0. The trajectory may name joints
/// of the arm in any order. Joints that it does not name come to rest before its first point. `delay`: time from now to
/// the beginning of the trajectory, >= 0 [s]. Missing velocities are computed from the angles; accelerations are
/// ignored. @returns the error; empty if the trajectory is valid.
std::string readTrajectory(const trajectory_msgs::JointTrajectory& message, const ArmDescription& arm,
                           const std::vector<JointMotion>& present, double delay, std::vector<ArmSetPoint>& points);

/// Error in the joint names of a trajectory; empty if the names are valid.
std::string jointErrors(const trajectory_msgs::JointTrajectory& message, const ArmDescription& arm);

/// Set points that bring all joints from the state `present` to rest, all at one time.
std::vector<ArmSetPoint> stopFrom(const std::vector<JointMotion>& present);
}  // namespace hjt
