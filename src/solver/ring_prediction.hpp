// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "solver/ring_state.hpp"

namespace hjt
{
/// First guess of the ring's equilibrium at a new position.
///
/// Whole tooth pitches of wave generator travel renumber the teeth. What is left of a pitch is a cubic between the
/// state and its copy one pitch on, forwards or back, with the tangents at both ends; the rest of the output's angle
/// goes along its own tangent. Where the ring repeats after half a turn, the states of the last pitches are kept by
/// their place in the pitch: the guess goes along the tangents of the nearest one. The error of the last guess
/// corrects the next one, as far as the last two errors were similar: errors of single teeth stay where they are,
/// while the guess takes them for turning with the wave generator.
class RingPrediction
{
public:
  explicit RingPrediction(const RingModel& model);

  void setModel(const RingModel& copied) noexcept { model_ = &copied; }  ///< see RingEquilibrium

  /// Predicts from the equilibrium that the last prediction has led to.
  void predict(const DrivePosition& target, RingState& state) noexcept;

  /// To be called if the state was reached otherwise than by `predict`.
  void forget() noexcept;

  /// The last guess started from a state that was kept: the rates of `state` are not of its teeth.
  bool fromKept() const noexcept { return from_.kept >= 0; }

  /// Gives `state` those of the kept state that the last guess started from, and its stiffness.
  void takeKeptRates(RingState& state) const noexcept;

  /// Keeps a solved state for guesses to come.
  void keep(const RingState& state) noexcept;

private:
  /// A solved state, but for its points, rates and spaces.
  struct Kept
  {
    bool known{ false };
    DrivePosition position;
    Eigen::Matrix2d stiffness;
    double cup_stiffness{};
  };
  /// A kept state turned by whole pitches.
  struct Source
  {
    int kept{ -1 };  // -1: none
    int places{};    // of the half ring's teeth
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
  double pitch_output_angle_;  // the output's turn that renumbers the spaces along with one tooth pitch [rad]
  bool guessed_{ false };
  Source from_;             // of the last guess
  std::vector<Kept> kept_;  // over one pitch
  // Of a state that is known, else not set: points of the first half of the teeth and their rates by wave generator and
  // by output, a column each; spaces of all teeth.
  Eigen::MatrixXd kept_vectors_;
  Eigen::MatrixXi kept_spaces_;
  Eigen::VectorXd guess_;        // the last, not corrected
  Eigen::VectorXd guess_error_;  // of the one before
  // Scratch, sized once.
  Eigen::VectorXd scratch_;
  std::vector<int> old_space_;
};
}  // namespace hjt
