// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "model/ring_model.hpp"
#include "solver/cyclic_solver.hpp"

namespace hjt
{
enum class SolveCode
{
  CONVERGED,
  NOT_CONVERGED,  ///< the iterations ran out or no step reduced the forces
  SINGULAR,       ///< the tangent has no inverse
  NOT_FINITE      ///< NaN or Inf came up
};

/// What a solve says of itself; the caller must look.
struct [[nodiscard]] SolveStatus
{
  SolveCode code{ SolveCode::CONVERGED };
  int iterations{};   ///< Newton iterations, all attempts
  int cuts{};         ///< halvings of the path
  int jumps{};        ///< teeth that changed their space through a tip: ratcheting, or too long a move
  double residual{};  ///< largest out-of-balance force component on a tooth [N]

  bool ok() const noexcept { return code == SolveCode::CONVERGED; }
};

/// The ring in equilibrium for a position of wave generator and circular spline.
///
/// Newton with the analytic tangent, line search, and continuation: a target that is not reached directly is approached
/// over halved paths. Tooth pairing changes only between solves and out of contact. On failure the last good state stays.
///
/// An insertion that fails so is done once more as a descent of the stored energy: exact line search on its slope, and a
/// shifted tangent where that is not positive. Slower, but teeth that touch and let go by the dozen do not stop it.
class RingEquilibrium
{
public:
  RingEquilibrium(const RingModel& model, const SolverParameters& parameters);

  /// Cold start: from the round ring the wave amplitude grows to its full value, in the circular spline if it goes, else
  /// before the circular spline is put on.
  SolveStatus insert(const DrivePosition& target) noexcept;

  /// From a guess at the tooth points [2 N, m]; every tooth pairs with the space nearest to it at rest.
  SolveStatus relax(const Eigen::VectorXd& points, const DrivePosition& position) noexcept;

  /// As `insert`, in mid-run, where `moveTo` found no way: the teeth pair anew. On failure the present state stays.
  SolveStatus reinsert(const DrivePosition& target) noexcept;

  /// After a change of the model: to its equilibrium at the present position, inserted anew if there is no way to it.
  /// `moveTo` does so first if nobody has.
  SolveStatus followModel() noexcept;

  /// From the present equilibrium to another position.
  SolveStatus moveTo(const DrivePosition& target) noexcept;

  /// Where `moveTo` found no way because the ring snaps: downhill in energy to the next equilibrium, teeth that are lifted
  /// out of their spaces pairing anew on the way. Slow; `iterations` counts its steps. On failure the last state stays.
  SolveStatus settle(const DrivePosition& target) noexcept;

  const RingModel& model() const noexcept { return model_; }
  const RingShape& shape() const noexcept { return now_.shape; }
  const DrivePosition& position() const noexcept { return now_.position; }
  const RingForces& forces() const noexcept { return forces_; }

  /// Rates of the tooth points by wave generator angle and by output angle, the ring staying in equilibrium [m/rad].
  /// Of the last factored tangent: with the teeth that touch now, at a shape at most a Newton step away.
  const Eigen::VectorXd& byWaveGenerator() const noexcept { return now_.by_wave_generator; }
  const Eigen::VectorXd& byOutput() const noexcept { return now_.by_output; }

  /// Second derivatives of the stored energy by (wave generator, output) angle, the ring following [N.m/rad].
  const Eigen::Matrix2d& stiffness() const noexcept { return now_.stiffness; }

  /// Output speed over wave generator speed at constant load: from the stiffness, not from the tooth numbers; 0 where the
  /// output hangs free [-].
  double follow() const noexcept
  {
    return now_.stiffness(1, 1) > 0.0 ? -now_.stiffness(1, 0) / now_.stiffness(1, 1) : 0.0;
  }

private:
  /// All that a failed move must bring back.
  struct Equilibrium
  {
    explicit Equilibrium(const RingModel& model);

    RingShape shape;
    DrivePosition position;
    Eigen::VectorXd by_wave_generator;
    Eigen::VectorXd by_output;
    Eigen::Matrix2d stiffness;
    double residual{};  // [N]
  };

  SolveStatus insertWedged(const DrivePosition& target) noexcept;
  void beginRound(const DrivePosition& target) noexcept;
  void begin(const Eigen::VectorXd& points, const DrivePosition& position) noexcept;
  void updateForces() noexcept;
  SolveStatus approach(const DrivePosition& target) noexcept;
  bool descend(double damping) noexcept;
  void turn(const Eigen::VectorXd& values, int pitches, Eigen::VectorXd& turned) const noexcept;
  void turnSpaces(int pitches) noexcept;
  void shift(int pitches) noexcept;
  void predict(const DrivePosition& target) noexcept;
  void guess(const DrivePosition& target) noexcept;
  void forgetGuess() noexcept;
  SolveStatus solve(const DrivePosition& target) noexcept;
  bool refactor() noexcept;
  bool slopesChanged() const noexcept;
  void solveStep() noexcept;
  bool searchLine(double residual) noexcept;
  double rounding() noexcept;
  bool stepDownhill() noexcept;
  bool downhill() noexcept;
  double slopeAt(double length) noexcept;
  void updateSensitivities() noexcept;

  const RingModel& model_;
  std::uint64_t model_version_;  // that the present state is of
  SolverParameters parameters_;
  double pitch_output_angle_;  // the output's turn that renumbers the spaces along with one tooth pitch [rad]
  bool descending_{ false };   // down the energy, not by Newton's method alone
  CyclicSolver solver_;
  RingTangent tangent_;
  RingForces forces_;
  Equilibrium now_;
  Equilibrium start_;    // of the present move
  Equilibrium halfway_;  // the farthest point of the present move
  Equilibrium kept_;     // before inserting anew
  bool circular_spline_in_{ true };
  // Scratch, sized once.
  Eigen::VectorXd start_points_;
  Eigen::VectorXd scratch_;
  std::vector<int> old_space_;
  std::vector<char> factored_meshed_;  // when the tangent was factored
  Eigen::VectorXd factored_depth_;     // of the wave generator's contact then
  // Of the last move, where it has led to the present state.
  bool guessed_{ false };
  Eigen::VectorXd guess_;        // without what the guess before was off by
  Eigen::VectorXd guess_error_;  // of the guess before
  Eigen::VectorXd step_;
  Eigen::VectorXd start_forces_;
  // Of the last factored tangent, once known.
  Eigen::VectorXd by_wave_generator_;
  Eigen::VectorXd by_output_;
  bool rates_known_{ false };
};
}  // namespace hjt
