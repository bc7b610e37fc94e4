// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <trajectory_msgs/JointTrajectory.h>

#include "arm/arm_motion.hpp"

namespace hjt
{
/// Set points of a trajectory, which may name joints of the arm in any order, after the present one at time 0. Other
/// joints come to rest before its first point and stay there. `delay`: time from now to the trajectory's beginning, >=
/// 0 [s]. Missing velocities follow from the angles; accelerations are ignored. @returns the error; empty if the
/// trajectory is valid.
std::string readTrajectory(const trajectory_msgs::JointTrajectory& message, const ArmDescription& arm,
                           const std::vector<JointMotion>& present, double delay, std::vector<ArmSetPoint>& points);

/// Error in the names of the joints; empty if they are valid.
std::string jointErrors(const trajectory_msgs::JointTrajectory& message, const ArmDescription& arm);

/// Set points from the present state to rest, for all joints at once.
std::vector<ArmSetPoint> stopFrom(const std::vector<JointMotion>& present);
}  // namespace hjt
