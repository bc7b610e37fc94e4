// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// One point of the loop.
struct TorsionPoint
{
  double torque{};        ///< load on the circular spline that moves it there [N.m]
  double output_angle{};  ///< circular spline from its place without load, > 0 with the load [rad]
};

/// Wave generator locked, load swept slowly to and fro: torsion with the friction of the teeth.
struct TorsionLoop
{
  SolveStatus status;                ///< the numbers hold if ok()
  std::vector<TorsionPoint> points;  ///< from +amplitude to -amplitude and back
  double hysteresis{};               ///< width of the loop at no load [rad]
  double lost_motion{};              ///< angle between the middles of the loop at + and - the lost motion torque [rad]
};

/// `amplitude`: largest load, > 0 [N.m]; `lost_motion_torque`: e.g. 4 % of the rated torque, > 0, at most the amplitude
/// [N.m]; `steps`: angles of one sweep, >= 2. @throws InputError if one is out of range.
TorsionLoop analyseTorsionLoop(const Parameters& parameters, double amplitude, double lost_motion_torque, int steps);
}  // namespace hjt
