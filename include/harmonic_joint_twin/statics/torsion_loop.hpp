// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// One point of the torsion loop.
struct TorsionPoint
{
  double torque{};  ///< load on the circular spline [N.m]
  /// angle of the circular spline from its position without load, > 0 in the direction of the load [rad]
  double output_angle{};
};

/// Torsion of the gear under a slow load cycle, with friction of the teeth and a locked wave generator.
struct TorsionLoop
{
  SolveStatus status;                ///< status of all solves; the numbers are valid if ok()
  std::vector<TorsionPoint> points;  ///< points from the largest load to minus this load and back
  double hysteresis{};               ///< width of the loop at zero load [rad]
  /// angle between the middles of the loop at the positive and the negative lost motion torque [rad]
  double lost_motion{};
};

/// Computes the loop. `amplitude`: largest load, > 0 [N.m]; `lost_motion_torque`: load at which the lost motion is
/// measured, for example 4 % of the rated torque, > 0 and at most the amplitude [N.m]; `steps`: number of steps of the
/// load in each direction, >= 2. @throws InputError if an argument is out of range.
TorsionLoop analyseTorsionLoop(const Parameters& parameters, double amplitude, double lost_motion_torque, int steps);
}  // namespace hjt
