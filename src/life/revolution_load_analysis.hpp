// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "life/ageing_laws.hpp"
#include "statics/flexspline_stress.hpp"
#include "statics/pitch_walk.hpp"
#include "statics/race_creep.hpp"

namespace hjt
{
/// Measures on the tooth model what turning does to the drive. One drive, any number of loads.
class RevolutionLoadAnalysis
{
public:
  /// `positions`: wave generator angles per tooth pitch, >= 1. @throws ParameterError if the parameters have no
  /// equilibrium.
  RevolutionLoadAnalysis(const Parameters& parameters, int positions)
    : RevolutionLoadAnalysis(startingJoint(parameters), parameters.solver, FlexsplineStress(parameters),
                             RaceCreep(parameters), positions)
  {
  }
  /// The same of a joint of that drive with other faults.
  RevolutionLoadAnalysis(const JointModel& joint, const SolverParameters& solver, const FlexsplineStress& stress,
                         const RaceCreep& creep, int positions);

  /// One turn of the wave generator under `load_torque` [N.m].
  /// @throws ParameterError if the ring finds no equilibrium under it.
  RevolutionLoad under(double load_torque);

private:
  int positions_;
  PitchWalk walk_;
  FlexsplineStress flexspline_stress_;
  ToothStress tooth_stress_;
  RaceCreep race_creep_;
  Eigen::VectorXd running_;  // of the teeth, by the wave generator's angle
};
}  // namespace hjt
