// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "solver/energy_descent.hpp"
#include "solver/ring_linearisation.hpp"

namespace hjt
{
/// Newton's method on the forces of the ring with the analytic tangent and line search. The factors serve on while the
/// forces contract well.
class NewtonSolver
{
public:
  /// `tolerance`: largest out-of-balance force of an equilibrium [N].
  NewtonSolver(const RingModel& model, int max_iterations, double tolerance);

  /// To the equilibrium at the state's position, from a state whose forces are the present ones.
  /// `descent`: takes the steps instead, down the energy; null: Newton's own. On failure the state is anywhere.
  SolveStatus solve(RingLinearisation& system, RingState& state, EnergyDescent* descent) noexcept;

private:
  SolveCode iterate(RingLinearisation& system, RingState& state, EnergyDescent* descent, SolveStatus& status) noexcept;
  bool searchLine(double residual, RingLinearisation& system, RingState& state) noexcept;

  int max_iterations_;
  double tolerance_;  // [N]
  Eigen::VectorXd start_points_;
};
}  // namespace hjt
