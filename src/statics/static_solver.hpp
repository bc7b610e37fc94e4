// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "model/faults/joint_faults.hpp"
#include "solver/ring_equilibrium.hpp"

namespace hjt
{
/// Parameters of the solver for static analyses: `parameters` with a force tolerance near the rounding errors.
inline SolverParameters staticSolver(SolverParameters parameters)
{
  constexpr double STATIC_TOLERANCE = 5e-7;  // [N]; the rounding error of a tooth's position causes a force of 2e-8 N
  parameters.force_tolerance = std::min(parameters.force_tolerance, STATIC_TOLERANCE);
  return parameters;
}

/// Moves the joint, with the faults that it starts with, quasi-statically through one tooth pitch of the wave generator
/// at constant load. With equal teeth one pitch represents a whole turn, because all teeth together go through the
/// states of one tooth in a turn.
class PitchWalk
{
public:
  /// `positions`: number of wave generator angles in a tooth pitch, >= 1.
  PitchWalk(const Parameters& parameters, int positions)
    : PitchWalk(startingJoint(parameters), parameters.solver, positions)
  {
  }
  PitchWalk(JointModel model, const SolverParameters& solver, int positions)
    : model_(std::move(model))
    , ring_(model_.ring, staticSolver(solver))
    , pitch_(TWO_PI / model_.ring.gear.teeth_flexspline)
    , positions_(positions)
    , status_(ring_.insert({ 0.0, 0.0, model_.ring.gear.wave_amplitude }))
  {
  }

  /// Calls `visit(output speed over motor speed)` in each position, up to a position without equilibrium. `load` [N.m].
  template <class Visit>
  void under(double load, Visit&& visit)
  {
    for (int i = 0; i < positions_ && status_.ok(); ++i)
    {
      status_ = balanceOutput(ring_, pitch_ * i / positions_, load);
      if (status_.ok())
      {
        visit(ring_.velocityRatio());
      }
    }
  }

  const JointModel& model() const { return model_; }
  const RingEquilibrium& ring() const { return ring_; }
  const SolveStatus& status() const { return status_; }

private:
  JointModel model_;
  RingEquilibrium ring_;
  double pitch_;
  int positions_;
  SolveStatus status_;
};
}  // namespace hjt
