// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "model/ring_model.hpp"
#include "solver/newton_solver.hpp"
#include "solver/ring_prediction.hpp"
#include "solver/ring_state.hpp"

namespace hjt
{
/// The ring in equilibrium at a position of wave generator and circular spline.
///
/// Newton's method (NewtonSolver) starts from a prediction (RingPrediction). If it fails, the target is approached over
/// halved paths. The spaces of the teeth change only between solves and out of contact. On failure the last state
/// stays. An insertion that fails is repeated by minimisation of the energy (EnergyDescent).
class RingEquilibrium
{
public:
  RingEquilibrium(const RingModel& model, const SolverParameters& parameters);

  /// Solves without a guess: the radial deflection grows from zero with the circular spline present. If that fails, it
  /// grows without the circular spline, which is then added.
  SolveStatus insert(const DrivePosition& target) noexcept;

  /// Solves from a guess of the tooth points [2 N, m]; every tooth gets the space nearest to it at rest.
  SolveStatus solveFrom(const Eigen::VectorXd& points, const DrivePosition& position) noexcept;

  /// Repeats the insertion during a run after `moveTo` failed, with new spaces for the teeth. On failure the state does
  /// not change.
  SolveStatus reinsert(const DrivePosition& target) noexcept;

  /// Solves at the present position after a change of the model and, if that fails, repeats the insertion. `moveTo`
  /// calls this function if the caller did not.
  SolveStatus updateModel() noexcept;

  /// Computes rates and stiffness at the present shape; those of `moveTo` belong to one Newton step before. @returns
  /// false and changes nothing if the tangent has no inverse.
  bool refreshSensitivities() noexcept;

  /// Solves for the equilibrium at another position from the present one.
  SolveStatus moveTo(const DrivePosition& target) noexcept;

  /// Solves at another position from a guess of its tooth points. The model must not have changed since the last move.
  SolveStatus moveTo(const DrivePosition& target, const Eigen::VectorXd& guess) noexcept;

  /// Minimises the energy at the target after `moveTo` failed because the ring snaps. Teeth that leave their space get
  /// the nearest one. The method is slow; `iterations` counts its steps. On failure the state does not change.
  SolveStatus descend(const DrivePosition& target) noexcept;

  /// Calls `moveTo`, then on failure `descend`, and then `reinsert`.
  SolveStatus reach(const DrivePosition& target) noexcept;

  /// Solves as `moveTo`, but with ten times the tolerance, which suffices for `torques` in a step of motion. Rates and
  /// stiffness may belong to a nearby state.
  SolveStatus follow(const DrivePosition& target) noexcept;

  const RingModel& model() const noexcept { return *model_; }
  /// Refers a copy of this object to a copy of its model.
  void setModel(const RingModel& copied) noexcept
  {
    model_ = &copied;
    system_.setModel(copied);
    prediction_.setModel(copied);
    descent_.setModel(copied);
  }
  const RingShape& shape() const noexcept { return now_.shape; }
  const DrivePosition& position() const noexcept { return now_.position; }
  const RingForces& forces() const noexcept { return system_.forces(); }

  /// Rounding error of a coordinate as a force [N]: the least tolerance of a solve.
  double rounding() const noexcept { return rounding_; }

  /// Torques on wave generator and output, corrected to first order for the remaining out-of-balance forces of the
  /// teeth [N.m].
  Eigen::Vector2d torques() const noexcept;

  /// Derivatives of the tooth points by wave generator angle and by output angle in equilibrium [m/rad]. They are those
  /// of the last factored tangent: with the present contacts, at a shape at most a Newton step away.
  const Eigen::VectorXd& byWaveGenerator() const noexcept { return now_.by_wave_generator; }
  const Eigen::VectorXd& byOutput() const noexcept { return now_.by_output; }

  /// Second derivatives of the stored energy by (wave generator, output) angle, with the ring in equilibrium [N.m/rad].
  const Eigen::Matrix2d& stiffness() const noexcept { return now_.stiffness; }

  /// Output speed over wave generator speed at constant load, from the stiffness; 0 if the output is free [-].
  double velocityRatio() const noexcept
  {
    return now_.stiffness(1, 1) > 0.0 ? -now_.stiffness(1, 0) / now_.stiffness(1, 1) : 0.0;
  }

private:
  SolveStatus insertWedged(const DrivePosition& target) noexcept;
  SolveStatus reachAfter(SolveStatus status, const DrivePosition& target) noexcept;
  void beginRound(const DrivePosition& target) noexcept;
  void begin(const Eigen::VectorXd& points, const DrivePosition& position) noexcept;
  void followModel() noexcept;
  void restore(const RingState& state) noexcept;
  SolveStatus approach(const DrivePosition& target) noexcept;
  SolveStatus solve(const DrivePosition& target) noexcept;
  SolveStatus solvePredicted() noexcept;
  double measureRounding() noexcept;

  const RingModel* model_;
  std::uint64_t model_version_;  // version of the model for the present state
  RingState now_;
  RingState start_;    // start of the present move; its directions and lengths are not computed
  RingState halfway_;  // the farthest point of the present move
  RingState kept_;     // state before the insertion was repeated
  RingLinearisation system_;
  double rounding_;   // [N]
  double tolerance_;  // largest out-of-balance force of an equilibrium [N]
  int max_step_cuts_;
  RingPrediction prediction_;
  EquilibriumGoal goal_;
  NewtonSolver newton_;
  EnergyDescent descent_;
  bool descending_{ false };  // minimises the energy instead of Newton's method
  Eigen::VectorXd round_;     // working memory
};

/// Moves the ring to a wave generator angle [rad] and the output to the angle at which the mesh balances `load_torque`
/// [N.m] (> 0 resists positive rotation), by Newton's method with the ring's condensed stiffness.
///
/// A trust region limits the step. It begins at a hundredth of a tooth space, grows while the torque approaches the
/// load, and shrinks otherwise. Without stiffness (backlash) a step has the length of the region. On failure
/// `unbalanced_torque` is the difference at the last angle.
SolveStatus balanceOutput(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;

/// Inserts the wave generator at its full amplitude and balances the load.
SolveStatus insertUnderLoad(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;

/// Torque at the output that counts as balanced [N.m]: 1e-11 of the torque that turns the output by a tooth space at
/// the present stiffness, or the rounding error of the ring's forces.
double balanceTolerance(const RingEquilibrium& ring) noexcept;
}  // namespace hjt
