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

  /// Computes the forces at `state`, without those of the circular spline if `circular_spline_in` is false.
  void updateForces(const RingState& state) noexcept;
  void updateTangent(const RingState& state) noexcept;  ///< requires updateForces of this state
  void shift(double stiffness) noexcept;                ///< adds a stiffness to the diagonal of every tooth [N/m]
  bool factor() noexcept { return solver().factor(tangent_); }

  /// Computes tangent and factors for `state`, after updateForces. @returns false if the tangent has no inverse.
  bool refactor(const RingState& state) noexcept;

  /// Whether the slopes in the tangent changed: either the cup is on another slope than `state.cup_stiffness`, or a
  /// contact began or ended since `refactor`. `all_teeth`: whether contacts of teeth with flanks count too.
  bool slopesChanged(const RingState& state, bool all_teeth) const noexcept;
  /// Whether the slopes changed since `refactor`.
  bool slopesChanged(bool all_teeth) const noexcept;

  /// Computes the Newton step of the tooth points from the forces and the factored tangent [m].
  void solve(Eigen::VectorXd& step) noexcept;

  /// Newton step of the tooth points [m]. The first call after `refactor` also computes the derivatives of the points
  /// by both angles, because a solve with three columns costs little more than a solve with one.
  const Eigen::VectorXd& newtonStep() noexcept;

  /// Moves the derivatives and the stiffness of the last `refactor` to the state.
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
  CyclicSolver half_solver_;  // solver for a ring that repeats after half a turn
  RingTangent tangent_;
  RingForces forces_;
  std::vector<char> factored_meshed_;
  Eigen::VectorXd factored_depth_;  // depths in the wave generator's contact at the last `refactor` [m]
  // Whether the derivatives by both angles of the last factored tangent are computed, and results of this tangent.
  bool rates_known_{};
  Eigen::VectorXd step_;
  Eigen::VectorXd by_wave_generator_;
  Eigen::VectorXd by_output_;
};

/// Minimisation of the ring's stored energy for cases where Newton's method on the forces fails. The minimisation is
/// slower than Newton's method, but robust if dozens of teeth begin and end contact.
class EnergyDescent
{
public:
  /// `tolerance`: largest out-of-balance force of an equilibrium [N].
  EnergyDescent(const RingModel& model, double tolerance);

  void setModel(const RingModel& copied) noexcept { model_ = &copied; }  ///< see RingEquilibrium::setModel

  /// Takes one Newton step on a factored tangent. First the diagonal of the tangent is increased until the energy
  /// decreases along the step. The step has its whole length if the energy still decreases or is nearly level at its
  /// end, else it ends near the lowest energy. The search compares slopes only, because energies near a minimum differ
  /// by less than their rounding. @returns false if the energy decreases along no step.
  bool step(RingLinearisation& system, RingState& state) noexcept;

  /// Moves the tooth points to the next minimum of the energy by damped steps. Teeth that leave their space get the
  /// nearest space. SolveStatus::iterations counts the steps. On failure the state is undefined.
  SolveStatus descend(RingLinearisation& system, RingState& state) noexcept;

private:
  bool findWayDown(RingLinearisation& system, const RingState& state) noexcept;
  double slopeAt(double length, RingLinearisation& system, RingState& state) noexcept;
  bool dampedStep(double damping, RingLinearisation& system, RingState& state) noexcept;
  bool pairsAgain(RingState& state) noexcept;

  const RingModel* model_;
  double tolerance_;  // largest out-of-balance force of an equilibrium [N]
  Eigen::VectorXd start_points_;
  Eigen::VectorXd start_forces_;
  Eigen::VectorXd step_;
  std::vector<int> old_space_;
};

struct EquilibriumGoal
{
  double residual;     ///< largest allowed out-of-balance force component on a tooth [N]
  double guess;        ///< largest force component at which a first guess is accepted without a Newton step [N]
  bool present_rates;  ///< whether derivatives and stiffness must be those of the present contacts
};

/// Newton's method on the forces of the ring with the analytic tangent and a line search. The method uses the factors
/// of a tangent again if the largest force decreased to a tenth in the last step.
class NewtonSolver
{
public:
  NewtonSolver(const RingModel& model, int max_iterations);

  /// Solves for the equilibrium at the state's position. Requires updateForces of this state. `descent`: minimisation
  /// of the energy in place of Newton's method, or null. On failure the state is undefined.
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
