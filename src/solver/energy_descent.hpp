// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "solver/ring_linearisation.hpp"

namespace hjt
{
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
}  // namespace hjt
