// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "solver/ring_state.hpp"

namespace hjt
{
/// First guess of the ring's equilibrium at a new position.
///
/// If the wave generator turns by whole tooth pitches, the guess is the old state with renumbered teeth. For the
/// remaining fraction of a pitch the guess is a cubic between this state and its copy one pitch further, forwards or
/// backwards, with the tangents of both states. The derivative by the output angle gives the effect of a change of the
/// torsion. If the ring repeats after half a turn, the prediction stores the states of the last pitches by their
/// position in the pitch, and the guess follows the tangent of the nearest stored state. The error of the last guess
/// corrects the next guess as far as the last two errors were similar. Errors that single teeth cause are not similar.
class RingPrediction
{
public:
  explicit RingPrediction(const RingModel& model);

  void setModel(const RingModel& copied) noexcept { model_ = &copied; }  ///< see RingEquilibrium::setModel

  /// Replaces `state` by the guess at `target`. `state`: the equilibrium that was solved from the last guess.
  void predict(const DrivePosition& target, RingState& state) noexcept;

  /// Forgets the last guess and all stored states. Must be called if the state was not solved from the last guess.
  void forget() noexcept;

  /// Whether the last guess started from a stored state. Then the derivatives in `state` are not those of its teeth.
  bool fromKept() const noexcept { return from_.kept >= 0; }

  /// Copies the derivatives and the stiffness of the stored state that the last guess started from to `state`.
  void takeKeptRates(RingState& state) const noexcept;

  /// Stores a solved state for later guesses.
  void keep(const RingState& state) noexcept;

private:
  /// Part of a stored state; kept_vectors_ and kept_spaces_ hold its points, their derivatives and the spaces.
  struct Kept
  {
    bool known{ false };
    DrivePosition position;
    Eigen::Matrix2d stiffness;
    double cup_stiffness{};
  };
  /// Stored state from which a guess starts, and the turn by whole pitches from this state to the guess.
  struct Source
  {
    int kept{ -1 };  // index of the stored state; -1: none
    int places{};    // number of pitches of the turn within the half ring
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
  double pitch_output_angle_;  // turn of the output while the wave generator turns by a tooth pitch [rad]
  bool guessed_{ false };
  Source from_;             // source of the last guess
  std::vector<Kept> kept_;  // stored states over one pitch
  // For each known stored state three columns: points of the first half of the teeth, their derivatives by wave
  // generator angle, and their derivatives by output angle. The columns of kept_spaces_ hold the spaces of all teeth.
  Eigen::MatrixXd kept_vectors_;
  Eigen::MatrixXi kept_spaces_;
  Eigen::VectorXd guess_;        // last guess without correction [m]
  Eigen::VectorXd guess_error_;  // error of the guess before the last one [m]
  Eigen::VectorXd scratch_;
  std::vector<int> old_space_;
};
}  // namespace hjt
