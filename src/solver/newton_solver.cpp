// SPDX-License-Identifier: BSD-3-Clause
#include "solver/newton_solver.hpp"

#include <cmath>

#include "solver/ring_vectors.hpp"

namespace hjt
{
NewtonSolver::NewtonSolver(const RingModel& model, int max_iterations)
  : max_iterations_(max_iterations), start_points_(model.rest.points())
{
}

SolveStatus NewtonSolver::solve(const EquilibriumGoal& goal, RingLinearisation& system, RingState& state,
                                EnergyDescent* descent) noexcept
{
  SolveStatus status;
  status.residual = system.residual();
  if (status.residual <= goal.guess && !system.slopesChanged(state, goal.present_rates))
  {
    state.residual = status.residual;
    return status;  // the tangent of the last solve is good enough to have predicted this
  }
  status.code = iterate(goal, system, state, descent, status);
  if (status.ok() && system.slopesChanged(goal.present_rates) && !system.refactor(state))
  {
    status.code = SolveCode::SINGULAR;
  }
  if (status.ok())
  {
    system.moveSensitivities(state);
    state.residual = status.residual;
  }
  return status;
}

SolveCode NewtonSolver::iterate(const EquilibriumGoal& goal, RingLinearisation& system, RingState& state,
                                EnergyDescent* descent, SolveStatus& status) noexcept
{
  constexpr double GOOD_CONTRACTION = 0.1;  // better than this, the factors serve another iteration
  constexpr int DESCENT = 5;                // times as many iterations: one for every few teeth that touch or let go
  const int max_iterations = (descent != nullptr ? DESCENT : 1) * max_iterations_;
  bool fresh = false;
  while (std::isfinite(status.residual))
  {
    const bool near = status.residual <= (status.iterations > 0 ? goal.residual : goal.guess);
    const bool good_rates = fresh || (near && status.iterations > 0 && !goal.present_rates);
    if (!good_rates && !system.refactor(state))
    {
      return SolveCode::SINGULAR;
    }
    if (near)
    {
      return SolveCode::CONVERGED;
    }
    if (++status.iterations > max_iterations)
    {
      status.max_iterations = max_iterations_;
      return SolveCode::ITERATION_LIMIT;
    }
    if (!(descent != nullptr ? descent->step(system, state) :
                               searchLine(status.residual, goal.residual, system, state)))
    {
      return SolveCode::NO_DESCENT;
    }
    const double residual = system.residual();
    fresh = descent == nullptr && residual < GOOD_CONTRACTION * status.residual;
    status.residual = residual;
  }
  return SolveCode::NOT_FINITE;
}

/// One Newton step, shortened until the largest force falls (or is at the level of rounding).
bool NewtonSolver::searchLine(double residual, double enough, RingLinearisation& system, RingState& state) noexcept
{
  constexpr int MAX_HALVINGS = 7;
  const Eigen::VectorXd& step = system.newtonStep();
  start_points_.swap(state.shape.points);
  double length = 1.0;
  for (int i = 0; i < MAX_HALVINGS; ++i, length *= 0.5)
  {
    ring_vectors::addScaled(start_points_, length, step, state.shape.points, state.shape.solved);
    state.shape.updateGeometry();
    system.updateForces(state);
    const double trial = system.residual();
    if (trial < (1.0 - 1e-4 * length) * residual || trial <= enough)
    {
      return true;
    }
  }
  return false;
}
}  // namespace hjt
