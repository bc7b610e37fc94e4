// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "solver/energy_descent.hpp"
#include "solver/ring_linearisation.hpp"

namespace hjt
{
/// What is asked of an equilibrium.
struct EquilibriumGoal
{
  double residual;     ///< largest out-of-balance force component on a tooth [N]
  double guess;        ///< the same of a first guess that is taken as it is [N]
  bool present_rates;  ///< rates and stiffness with the teeth that touch now
};

/// Newton's method on the forces of the ring with the analytic tangent and line search. The factors serve on while the
/// forces contract well.
class NewtonSolver
{
public:
  NewtonSolver(const RingModel& model, int max_iterations);

  /// To the equilibrium at the state's position, from a state whose forces are the present ones.
  /// `descent`: takes the steps instead, down the energy; null: Newton's own. On failure the state is anywhere.
  SolveStatus solve(const EquilibriumGoal& goal, RingLinearisation& system, RingState& state,
                    EnergyDescent* descent) noexcept;

private:
  SolveCode iterate(const EquilibriumGoal& goal, RingLinearisation& system, RingState& state, EnergyDescent* descent,
                    SolveStatus& status) noexcept;
  bool searchLine(double residual, double enough, RingLinearisation& system, RingState& state) noexcept;

  int max_iterations_;
  Eigen::VectorXd start_points_;
};
}  // namespace hjt
