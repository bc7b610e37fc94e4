// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "solver/cyclic_solver.hpp"
#include "solver/ring_state.hpp"

namespace hjt
{
/// Forces on the ring at a state, their tangent and its factors.
class RingLinearisation
{
public:
  explicit RingLinearisation(const RingModel& model);

  void setModel(const RingModel& copied) noexcept { model_ = &copied; }  ///< see RingEquilibrium

  /// Forces at `state`; without the circular spline while `circular_spline_in` is false.
  void updateForces(const RingState& state) noexcept;
  void updateTangent(const RingState& state) noexcept;  ///< with the forces of the same state
  void shift(double stiffness) noexcept;                ///< adds to every tooth's own stiffness [N/m]
  bool factor() noexcept { return solver().factor(tangent_); }

  /// Tangent and factors of a state whose forces are the present ones. False: it has no inverse.
  bool refactor(const RingState& state) noexcept;

  /// Whether the cup has come to another slope since the rates of `state` were found, or a tooth on a ball, or any of
  /// `all_teeth`, has begun or ceased to touch since `refactor`.
  bool slopesChanged(const RingState& state, bool all_teeth) const noexcept;
  /// The same since `refactor` alone.
  bool slopesChanged(bool all_teeth) const noexcept;

  /// Steps of the tooth points that the factored tangent answers the present forces with [m].
  void solve(Eigen::VectorXd& step) noexcept;

  /// The same after `refactor`; with the first step come the rates by both angles: a sweep costs little more for three
  /// columns.
  const Eigen::VectorXd& newtonStep() noexcept;

  /// Rates and stiffness of the last `refactor`, handed over to the state.
  void moveSensitivities(RingState& state) noexcept;

  const RingForces& forces() const noexcept { return forces_; }
  double residual() const noexcept;  ///< largest force component on a tooth [N]
  double stiffest() const noexcept;  ///< largest entry on the tangent's diagonal [N/m]

  bool circular_spline_in{ true };

private:
  double cupStiffness() const noexcept;
  bool touchChanged(bool all_teeth) const noexcept;
  CyclicSolver& solver() noexcept { return tangent_.solved < tangent_.teeth() ? half_solver_ : solver_; }

  const RingModel* model_;
  CyclicSolver solver_;
  CyclicSolver half_solver_;  // of a ring that repeats after half a turn
  RingTangent tangent_;
  RingForces forces_;
  // When the tangent was factored.
  std::vector<char> factored_meshed_;
  Eigen::VectorXd factored_depth_;  // of the wave generator's contact
  // Of the last factored tangent, once known.
  bool rates_known_{};
  Eigen::VectorXd step_;
  Eigen::VectorXd by_wave_generator_;
  Eigen::VectorXd by_output_;
};

/// Ways down the ring's stored energy where Newton's method on the forces fails. Slower, but teeth that touch and let
/// go by the dozen do not stop them.
class EnergyDescent
{
public:
  /// `tolerance`: largest out-of-balance force of an equilibrium [N].
  EnergyDescent(const RingModel& model, double tolerance);

  void setModel(const RingModel& copied) noexcept { model_ = &copied; }  ///< see RingEquilibrium

  /// One Newton step on a factored tangent, which is shifted where it is not positive along the step: all the way if
  /// that is still downhill or nearly level, else to where the energy is lowest. Looks at slopes only: energies near a
  /// minimum differ by less than their rounding. False: no way down.
  bool step(RingLinearisation& system, RingState& state) noexcept;

  /// To the next minimum at the state's position, by damped steps that lower the energy; teeth that are lifted out of
  /// their spaces pair again on the way. `iterations` counts the steps. On failure the state is anywhere.
  SolveStatus descend(RingLinearisation& system, RingState& state) noexcept;

private:
  bool findWayDown(RingLinearisation& system, const RingState& state) noexcept;
  double slopeAt(double length, RingLinearisation& system, RingState& state) noexcept;
  bool dampedStep(double damping, RingLinearisation& system, RingState& state) noexcept;
  bool pairsAgain(RingState& state) noexcept;

  const RingModel* model_;
  double tolerance_;  // [N]
  // Scratch, sized once.
  Eigen::VectorXd start_points_;
  Eigen::VectorXd start_forces_;
  Eigen::VectorXd step_;
  std::vector<int> old_space_;
};

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
