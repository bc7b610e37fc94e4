// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "solver/cyclic_solver.hpp"
#include "solver/ring_state.hpp"

namespace hjt
{
/// Forces on the ring at a state, with their tangent and its factors.
class RingLinearisation
{
public:
  explicit RingLinearisation(const RingModel& model);

  void setModel(const RingModel& copied) noexcept { model_ = &copied; }  ///< see RingEquilibrium::setModel

  /// Computes the forces at `state`; without those of the circular spline while `circular_spline_in` is false.
  void updateForces(const RingState& state) noexcept;
  void updateTangent(const RingState& state) noexcept;  ///< requires the forces of this state
  void shift(double stiffness) noexcept;                ///< adds a stiffness to the diagonal of every tooth [N/m]
  bool factor() noexcept { return solver().factor(tangent_); }

  /// Computes tangent and factors for the state of the present forces. @returns false if the tangent has no inverse.
  bool refactor(const RingState& state) noexcept;

  /// Whether the tangent's slopes changed: the cup is on another slope than for the rates of `state`, or since
  /// `refactor` the contact of a tooth on a ball, or of any tooth if `all_teeth`, has begun or ended.
  bool slopesChanged(const RingState& state, bool all_teeth) const noexcept;
  /// Whether the slopes changed since `refactor`.
  bool slopesChanged(bool all_teeth) const noexcept;

  /// Solves for the step of the tooth points by the factored tangent [m].
  void solve(Eigen::VectorXd& step) noexcept;

  /// Step after `refactor`. The first one also computes the rates by both angles, because a solve with three columns
  /// costs little more.
  const Eigen::VectorXd& newtonStep() noexcept;

  /// Moves rates and stiffness of the last `refactor` to the state.
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
  CyclicSolver half_solver_;  // for a ring that repeats after half a turn
  RingTangent tangent_;
  RingForces forces_;
  // State of the contacts in the factored tangent.
  std::vector<char> factored_meshed_;
  Eigen::VectorXd factored_depth_;  // depths in the wave generator's contact
  // Results of the last factored tangent, if computed.
  bool rates_known_{};
  Eigen::VectorXd step_;
  Eigen::VectorXd by_wave_generator_;
  Eigen::VectorXd by_output_;
};

/// Minimisation of the ring's stored energy for cases where Newton's method on the forces fails. It is slower, but
/// robust if dozens of teeth begin and end contact.
class EnergyDescent
{
public:
  /// `tolerance`: largest out-of-balance force of an equilibrium [N].
  EnergyDescent(const RingModel& model, double tolerance);

  void setModel(const RingModel& copied) noexcept { model_ = &copied; }  ///< see RingEquilibrium::setModel

  /// One Newton step on a factored tangent, which is shifted until it is positive along the step. The step is complete
  /// if it still goes downhill or nearly level at its end, else it goes to the lowest energy. Only slopes are compared,
  /// because energies near a minimum differ by less than their rounding. @returns false if no step goes downhill.
  bool step(RingLinearisation& system, RingState& state) noexcept;

  /// Moves to the next minimum at the state's position by damped steps that lower the energy. Teeth that leave their
  /// space are assigned their nearest one. `iterations` counts the steps. On failure the state is undefined.
  SolveStatus descend(RingLinearisation& system, RingState& state) noexcept;

private:
  bool findWayDown(RingLinearisation& system, const RingState& state) noexcept;
  double slopeAt(double length, RingLinearisation& system, RingState& state) noexcept;
  bool dampedStep(double damping, RingLinearisation& system, RingState& state) noexcept;
  bool pairsAgain(RingState& state) noexcept;

  const RingModel* model_;
  double tolerance_;  // [N]
  // Working memory.
  Eigen::VectorXd start_points_;
  Eigen::VectorXd start_forces_;
  Eigen::VectorXd step_;
  std::vector<int> old_space_;
};

struct EquilibriumGoal
{
  double residual;     ///< largest out-of-balance force component on a tooth [N]
  double guess;        ///< largest force of a first guess that is accepted without a step [N]
  bool present_rates;  ///< rates and stiffness must belong to the teeth in contact now
};

/// Newton's method on the forces of the ring with the analytic tangent and a line search. It keeps the factors while
/// the forces contract well.
class NewtonSolver
{
public:
  NewtonSolver(const RingModel& model, int max_iterations);

  /// Solves for the equilibrium at the state's position; the state must have up-to-date forces. `descent`: minimises
  /// the energy instead; null: Newton's method. On failure the state is undefined.
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
