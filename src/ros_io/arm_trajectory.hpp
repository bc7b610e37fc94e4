// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <trajectory_msgs/JointTrajectory.h>

#include "arm/arm_motion.hpp"

namespace hjt
{
/// Set points of a trajectory that names all joints of the arm, in any order, after one at time 0, the present one;
/// `delay`: from now to the trajectory's begin, >= 0 [s]. Velocities that it does not give follow from its angles; its
/// accelerations are not read. @returns what is wrong with it, or nothing.
std::string readTrajectory(const trajectory_msgs::JointTrajectory& message, const ArmDescription& arm,
                           const std::vector<JointMotion>& present, double delay, std::vector<ArmSetPoint>& points);
}  // namespace hjt
