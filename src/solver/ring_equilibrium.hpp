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
/// The ring in equilibrium for a position of wave generator and circular spline.
///
/// Starts Newton's method (NewtonSolver) from a prediction (RingPrediction); a target that is not reached directly is
/// approached over halved paths. Tooth pairing changes only between solves and out of contact. On failure the last good
/// state stays. An insertion that fails so is done once more down the stored energy (EnergyDescent).
class RingEquilibrium
{
public:
  RingEquilibrium(const RingModel& model, const SolverParameters& parameters);

  /// Cold start: the radial deflection is raised from zero with the circular spline in place; if that does not
  /// converge, without it, and the circular spline is added afterwards.
  SolveStatus insert(const DrivePosition& target) noexcept;

  /// Solves from a guess at the tooth points [2 N, m]; every tooth pairs with the space nearest to it at rest.
  SolveStatus solveFrom(const Eigen::VectorXd& points, const DrivePosition& position) noexcept;

  /// Repeats the insertion during a run after `moveTo` failed: the teeth are paired again. On failure the state is
  /// unchanged.
  SolveStatus reinsert(const DrivePosition& target) noexcept;

  /// After a change of the model: solves for its equilibrium at the present position and, if that fails, repeats the
  /// insertion. `moveTo` calls it if it was not called since the change.
  SolveStatus updateModel() noexcept;

  /// Computes rates and stiffness at the present shape itself; `moveTo` leaves those of one Newton step before it.
  /// False: the tangent has no inverse; rates and stiffness stay as they are.
  bool refreshSensitivities() noexcept;

  /// Solves for the equilibrium at another position, from the present one.
  SolveStatus moveTo(const DrivePosition& target) noexcept;

  /// The same from a guess at the tooth points there, of a model that has not changed since the last move.
  SolveStatus moveTo(const DrivePosition& target, const Eigen::VectorXd& guess) noexcept;

  /// After `moveTo` failed because the ring snaps: descends in energy to the next equilibrium; teeth that leave their
  /// spaces are paired again on the way. Slow; `iterations` counts its steps. On failure the state is unchanged.
  SolveStatus descend(const DrivePosition& target) noexcept;

  /// `moveTo`; where that fails `descend`, and where that fails too, or cannot help, `reinsert`.
  SolveStatus reach(const DrivePosition& target) noexcept;

  /// The same near enough for `torques` to be right, ten times the tolerance: a step of a joint's motion. Rates and
  /// stiffness may be those of a state nearby.
  SolveStatus follow(const DrivePosition& target) noexcept;

  const RingModel& model() const noexcept { return *model_; }
  /// A copy refers to the same model, until it gets a copy of that.
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

  /// Rounding of a coordinate as a force [N], the lower limit of any solve.
  double rounding() const noexcept { return rounding_; }

  /// On wave generator and output, as in equilibrium to the first order: with what the forces that are left over would
  /// do as the teeth give way to them [N.m].
  Eigen::Vector2d torques() const noexcept;

  /// Rates of the tooth points by wave generator angle and by output angle, the ring staying in equilibrium [m/rad].
  /// Of the last factored tangent: with the teeth that touch now, at a shape at most a Newton step away.
  const Eigen::VectorXd& byWaveGenerator() const noexcept { return now_.by_wave_generator; }
  const Eigen::VectorXd& byOutput() const noexcept { return now_.by_output; }

  /// Second derivatives of the stored energy by (wave generator, output) angle, the ring following [N.m/rad].
  const Eigen::Matrix2d& stiffness() const noexcept { return now_.stiffness; }

  /// Output speed over wave generator speed at constant load: from the stiffness, not from the tooth numbers; 0 where
  /// the output hangs free [-].
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
  std::uint64_t model_version_;  // that the present state is of
  RingState now_;
  RingState start_;    // of the present move; its directions and lengths are not known
  RingState halfway_;  // the farthest point of the present move
  RingState kept_;     // before the insertion was repeated
  RingLinearisation system_;
  double rounding_;   // [N]
  double tolerance_;  // largest out-of-balance force of an equilibrium [N]
  int max_step_cuts_;
  RingPrediction prediction_;
  EquilibriumGoal goal_;
  NewtonSolver newton_;
  EnergyDescent descent_;
  bool descending_{ false };  // down the energy, not by Newton's method
  Eigen::VectorXd round_;     // scratch
};

/// Moves the ring to a wave generator angle [rad] and the output to the angle at which the mesh balances `load_torque`
/// [N.m] (> 0 resists positive rotation): Newton on the output angle with the ring's condensed stiffness.
///
/// A step is bounded by a trust region, which begins at a hundredth of a tooth space, grows while the torque comes
/// closer and shrinks where it does not. Without stiffness (backlash) a step is as long as the region. On failure
/// `unbalanced_torque` is what the mesh lacks at the last angle.
SolveStatus balanceOutput(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;

/// Inserts the wave generator at its full amplitude and balances the load.
SolveStatus insertUnderLoad(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;

/// Torque at the output that counts as balanced [N.m]: 1e-11 of the torque which turns the output by a tooth space on
/// the present stiffness, or what rounding leaves of the ring's forces.
double balanceTolerance(const RingEquilibrium& ring) noexcept;
}  // namespace hjt
