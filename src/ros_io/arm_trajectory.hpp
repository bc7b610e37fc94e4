// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <trajectory_msgs/JointTrajectory.h>

#include "arm/arm_motion.hpp"

namespace hjt
{
/// Set points of a trajectory that names joints of the arm, in any order, after one at time 0, the present one; the
/// other joints come to rest until its first point and stay there. `delay`: from now to the trajectory's begin, >= 0
/// [s]. Velocities that it does not give follow from its angles; its accelerations are not read. @returns what is wrong
/// with it, or nothing.
std::string readTrajectory(const trajectory_msgs::JointTrajectory& message, const ArmDescription& arm,
                           const std::vector<JointMotion>& present, double delay, std::vector<ArmSetPoint>& points);

/// Error in the joints that it names, or nothing.
std::string jointErrors(const trajectory_msgs::JointTrajectory& message, const ArmDescription& arm);

/// From the present set point to rest, all joints at once.
std::vector<ArmSetPoint> stopFrom(const std::vector<JointMotion>& present);
}  // namespace hjt
