// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "solver/ring_state.hpp"

namespace hjt
{
/// First guess of the ring's equilibrium at a new position.
///
/// Whole tooth pitches of wave generator travel renumber the teeth. Over the remaining fraction of a pitch the guess is
/// a cubic between the state and its copy one pitch further, forwards or backwards, with the tangents at both ends. The
/// rest of the output's angle follows its own tangent. If the ring repeats after half a turn, the prediction stores the
/// states of the last pitches by their position in the pitch and uses the tangents of the nearest one. The error of the
/// last guess corrects the next one to the extent to which the last two errors were similar, because errors of single
/// teeth do not turn with the wave generator.
class RingPrediction
{
public:
  explicit RingPrediction(const RingModel& model);

  void setModel(const RingModel& copied) noexcept { model_ = &copied; }  ///< see RingEquilibrium::setModel

  /// Predicts from the equilibrium that the last prediction led to.
  void predict(const DrivePosition& target, RingState& state) noexcept;

  /// Must be called if `predict` did not lead to the state.
  void forget() noexcept;

  /// Whether the last guess started from a stored state. Then the rates of `state` do not belong to its teeth.
  bool fromKept() const noexcept { return from_.kept >= 0; }

  /// Copies rates and stiffness of that stored state to `state`.
  void takeKeptRates(RingState& state) const noexcept;

  /// Stores a solved state for later guesses.
  void keep(const RingState& state) noexcept;

private:
  /// A solved state without its points, rates and spaces.
  struct Kept
  {
    bool known{ false };
    DrivePosition position;
    Eigen::Matrix2d stiffness;
    double cup_stiffness{};
  };
  /// A stored state that is turned by whole pitches.
  struct Source
  {
    int kept{ -1 };  // -1: none
    int places{};    // number of teeth of the half ring by which it is turned
    double cosine{};
    double sine{};
  };
  double twistSince(const Kept& kept, const DrivePosition& position) const noexcept;
  bool guessFromKept(const DrivePosition& target, RingState& state) noexcept;
  void turnKept(const ring_vectors::Combination::Factors& factors, int half, Eigen::VectorXd& result) const noexcept;
  void guess(const DrivePosition& target, RingState& state) noexcept;
  void shift(int pitches, RingState& state) noexcept;
  void turn(const Eigen::VectorXd& values, int pitches, Eigen::VectorXd& turned) const noexcept;
  void turnSpaces(const int* space, int pitches, std::vector<int>& turned) const noexcept;

  const RingModel* model_;
  double pitch_cos_;
  double pitch_sin_;
  double pitch_output_angle_;  // turn of the output that renumbers the spaces by one, for one tooth pitch [rad]
  bool guessed_{ false };
  Source from_;             // source of the last guess
  std::vector<Kept> kept_;  // states over one pitch
  // Of a state that is known, else not set: points of the first half of the teeth and their rates by wave generator and
  // by output, a column each; spaces of all teeth.
  Eigen::MatrixXd kept_vectors_;
  Eigen::MatrixXi kept_spaces_;
  Eigen::VectorXd guess_;        // the last, not corrected
  Eigen::VectorXd guess_error_;  // of the one before
  // Working memory.
  Eigen::VectorXd scratch_;
  std::vector<int> old_space_;
};
}  // namespace hjt
