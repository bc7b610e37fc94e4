// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

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
}  // namespace hjt
