// SPDX-License-Identifier: BSD-3-Clause
#include "solver/energy_descent.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
EnergyDescent::EnergyDescent(const RingModel& model, double tolerance)
  : model_(&model)
  , tolerance_(tolerance)
  , start_points_(model.rest.points())
  , start_forces_(start_points_)
  , step_(start_points_)
  , old_space_(static_cast<std::size_t>(model.rest.teeth()))
{
}

/// Leaves the step in `step_`, its start in `start_points_`.
bool EnergyDescent::findWayDown(RingLinearisation& system, const RingState& state) noexcept
{
  constexpr int MAX_SHIFTS = 30;
  constexpr double FIRST_SHIFT = 1e-6;  // share of the stiffest diagonal entry
  double shift = 0.0;
  for (int i = 0; i < MAX_SHIFTS; ++i)
  {
    start_forces_ = system.forces().teeth;
    system.solve(step_);
    const double slope = step_.dot(start_forces_);
    if (std::isfinite(slope) && slope > 0.0)
    {
      start_points_ = state.shape.points;
      return true;
    }
    const double add = shift > 0.0 ? 3.0 * shift : FIRST_SHIFT * system.stiffest();
    system.shift(add);
    shift += add;
    if (!system.factor())
    {
      return false;
    }
  }
  return false;
}

/// Moves to `length` steps from the start. @returns how steeply the energy falls there along the step [J].
double EnergyDescent::slopeAt(double length, RingLinearisation& system, RingState& state) noexcept
{
  state.shape.points = start_points_ + length * step_;
  state.shape.updateGeometry();
  system.updateForces(state);
  return system.forces().teeth.dot(step_);
}

bool EnergyDescent::step(RingLinearisation& system, RingState& state) noexcept
{
  constexpr int MAX_TRIALS = 40;
  constexpr double LEVEL = 0.3;  // share of the first slope
  if (!findWayDown(system, state))
  {
    return false;
  }
  const double first = step_.dot(start_forces_);
  double low = 0.0;
  double high = 1.0;
  double length = 1.0;
  for (int i = 0; i < MAX_TRIALS; ++i)
  {
    const double slope = slopeAt(length, system, state);
    if (system.residual() <= tolerance_ || (length == 1.0 && slope >= -LEVEL * first) ||
        std::abs(slope) <= LEVEL * first)
    {
      return true;
    }
    (slope > 0.0 ? low : high) = length;
    length = 0.5 * (low + high);
  }
  return false;
}

/// Taken if it lowers the energy (or, at the level of rounding, the forces).
bool EnergyDescent::dampedStep(double damping, RingLinearisation& system, RingState& state) noexcept
{
  constexpr double ROUNDING = 1e-12;  // share of the energy
  const double energy = system.forces().energy;
  const double residual = system.residual();
  system.updateTangent(state);
  system.shift(damping);
  if (!system.factor())
  {
    return false;
  }
  system.solve(step_);
  start_points_ = state.shape.points;
  state.shape.points += step_;
  state.shape.updateGeometry();
  system.updateForces(state);
  const double now = system.forces().energy;
  if (now < energy * (1.0 - ROUNDING) || (now < energy * (1.0 + ROUNDING) && system.residual() < residual))
  {
    return true;
  }
  state.shape.points = start_points_;
  state.shape.updateGeometry();
  return false;
}

/// Whether teeth that have been lifted out are nearer to other spaces now.
bool EnergyDescent::pairsAgain(RingState& state) noexcept
{
  old_space_ = state.shape.space;
  if (model_->meshed())
  {
    model_->of<ToothMesh>().pairNearest(state.position, state.shape);
  }
  return old_space_ != state.shape.space;
}

SolveStatus EnergyDescent::descend(RingLinearisation& system, RingState& state) noexcept
{
  constexpr int MAX_STEPS = 200;         // snaps of teeth take up to 34; a step of a twin that runs must end
  constexpr double FIRST_DAMPING = 1e6;  // N/m, added to every tooth's stiffness
  constexpr double MIN_DAMPING = 1e-3;
  constexpr double MAX_DAMPING = 1e16;
  SolveStatus status;
  double damping = FIRST_DAMPING;
  while (status.iterations < MAX_STEPS && damping < MAX_DAMPING)
  {
    system.updateForces(state);
    status.residual = system.residual();
    if (status.residual > tolerance_)
    {
      ++status.iterations;
      damping = dampedStep(damping, system, state) ? std::max(MIN_DAMPING, 0.2 * damping) : 5.0 * damping;
    }
    else if (pairsAgain(state))
    {
      damping = FIRST_DAMPING;
    }
    else
    {
      status.code = system.refactor(state) ? SolveCode::CONVERGED : SolveCode::SINGULAR;
      return status;
    }
  }
  status.code = SolveCode::NO_DESCENT;
  return status;
}
}  // namespace hjt
