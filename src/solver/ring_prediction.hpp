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
/// goes along its own tangent. The error of the last guess corrects the next one, as far as the last two errors were
/// similar: errors of single teeth stay where they are, while the guess takes them for turning with the wave generator.
class RingPrediction
{
public:
  explicit RingPrediction(const RingModel& model);

  /// From the equilibrium that the last prediction has led to.
  void predict(const DrivePosition& target, RingState& state) noexcept;

  /// The state has come about otherwise.
  void forget() noexcept;

private:
  void guess(const DrivePosition& target, RingState& state) noexcept;
  void shift(int pitches, RingState& state) noexcept;
  void turn(const Eigen::VectorXd& values, int pitches, Eigen::VectorXd& turned) const noexcept;
  void turnSpaces(int pitches, RingShape& shape) noexcept;

  const RingModel& model_;
  double pitch_cos_;
  double pitch_sin_;
  double pitch_output_angle_;  // the output's turn that renumbers the spaces along with one tooth pitch [rad]
  bool guessed_{ false };
  Eigen::VectorXd guess_;        // the last, not corrected
  Eigen::VectorXd guess_error_;  // of the one before
  // Scratch, sized once.
  Eigen::VectorXd scratch_;
  std::vector<int> old_space_;
};
}  // namespace hjt
