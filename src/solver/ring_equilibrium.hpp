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
/// Newton's method (NewtonSolver) starts from a prediction (RingPrediction). If a move to new angles fails, it is
/// divided into shorter moves. If the shorter moves fail too, the last state stays. An insertion that fails is repeated
/// by minimisation of the energy (EnergyDescent). A tooth changes its space only between solves, out of contact.
class RingEquilibrium
{
public:
  RingEquilibrium(const RingModel& model, const SolverParameters& parameters);

  /// Solves without a guess: the amplitude of the wave generator grows from zero. If this fails because the round ring
  /// jams in the circular spline, the amplitude grows without the circular spline, which is then added.
  SolveStatus insert(const DrivePosition& target) noexcept;

  /// Solves from a guess of the tooth points [m]. Every tooth gets the space nearest to its angle at rest.
  SolveStatus solveFrom(const Eigen::VectorXd& points, const DrivePosition& position) noexcept;

  /// Repeats the insertion after `moveTo` failed. Every tooth gets the space nearest to it. On failure the state stays.
  SolveStatus reinsert(const DrivePosition& target) noexcept;

  /// Solves at the present position after a change of the model. If this fails, repeats the insertion. `moveTo` calls
  /// this function if the caller did not call it after the change.
  SolveStatus updateModel() noexcept;

  /// Computes byWaveGenerator(), byOutput() and stiffness() at the present shape. After `moveTo` the three are those of
  /// the shape before its last Newton step. @returns false and changes nothing if the tangent has no inverse.
  bool refreshSensitivities() noexcept;

  /// Moves from the present equilibrium to that at `target`.
  SolveStatus moveTo(const DrivePosition& target) noexcept;

  /// Solves at `target`, with the model unchanged, from a guess of the tooth points [m].
  SolveStatus moveTo(const DrivePosition& target, const Eigen::VectorXd& guess) noexcept;

  /// Minimises the energy at the target, for a ring that snaps so that `moveTo` failed. Teeth that leave their space
  /// get the nearest space. This is slower than `moveTo`. On failure the state does not change.
  SolveStatus descend(const DrivePosition& target) noexcept;

  /// Calls `moveTo`. If it fails, calls `descend` (with balls only). If no call succeeds, calls `reinsert`.
  SolveStatus reach(const DrivePosition& target) noexcept;

  /// Solves like `reach`, but with ten times the tolerance, which suffices for `torques` in a step of motion.
  /// byWaveGenerator(), byOutput() and stiffness() may belong to a nearby state.
  SolveStatus follow(const DrivePosition& target) noexcept;

  const RingModel& model() const noexcept { return *model_; }
  /// After a copy of a RingEquilibrium: makes the copy use `copied`, a copy of the original's model.
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

  /// Force by the rounding error of a coordinate of a tooth, which is the least tolerance of a solve [N].
  double rounding() const noexcept { return rounding_; }

  /// Torques on wave generator and output, corrected to first order for the forces that remain on the teeth [N.m].
  Eigen::Vector2d torques() const noexcept;

  /// Derivatives of the tooth points by wave generator angle and by output angle in equilibrium [m/rad]. They belong to
  /// the last factored tangent, with the present contacts and a shape at most a Newton step from the present one.
  const Eigen::VectorXd& byWaveGenerator() const noexcept { return now_.by_wave_generator; }
  const Eigen::VectorXd& byOutput() const noexcept { return now_.by_output; }

  /// Second derivatives of the energy by wave generator and output angle, with the ring in equilibrium [N.m/rad].
  const Eigen::Matrix2d& stiffness() const noexcept { return now_.stiffness; }

  /// Output speed over wave generator speed at constant load, from the stiffness [-]; 0 if the output has no stiffness.
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
  std::uint64_t model_version_;  // version of the model that the present state belongs to
  RingState now_;
  RingState start_;    // start of the present move, without the directions and lengths of its shape
  RingState halfway_;  // last solved state on the path of the present move
  RingState kept_;     // state before the insertion was repeated
  RingLinearisation system_;
  double rounding_;   // see rounding() [N]
  double tolerance_;  // largest out-of-balance force of an equilibrium [N]
  int max_step_cuts_;
  RingPrediction prediction_;
  EquilibriumGoal goal_;
  NewtonSolver newton_;
  EnergyDescent descent_;
  bool descending_{ false };  // whether the energy is minimised in place of Newton's method
  Eigen::VectorXd round_;     // working memory
};

/// Moves the wave generator to an angle [rad], and the output to the angle at which the mesh balances `load_torque`
/// [N.m] (> 0 resists positive rotation). The method is Newton's with the stiffness of the ring in equilibrium.
///
/// A trust region limits the step of the output angle. The region begins at a hundredth of a tooth space. The region
/// grows if the torque of the mesh comes nearer to the load, else it shrinks. Without stiffness (backlash) a step has
/// the length of the region. On failure SolveStatus::unbalanced_torque is the load minus the torque at the last angle.
SolveStatus balanceOutput(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;

/// Inserts the wave generator at its full amplitude, then calls balanceOutput.
SolveStatus insertUnderLoad(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;

/// Largest unbalanced torque at the output that counts as balanced [N.m]. It is 1e-11 of the torque that turns the
/// output by a tooth space at the present stiffness, or the rounding error of the ring's forces, whichever is larger.
double balanceTolerance(const RingEquilibrium& ring) noexcept;
}  // namespace hjt
