// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

namespace hjt
{
/// One line of a spectrum by turns of the motor, for each way of turning.
struct SpectrumLine
{
  double order{};  ///< per turn of the motor [-]
  double forward{};
  double backward{};
};

/// What repeats with the joint's angle in a residual, in orders of the motor's turn.
///
/// The residual is averaged over narrow bins of the joint's angle, both ways apart; so memory does not grow, time needs
/// not be even and what does not stay in place goes out. The amplitude at order o is |2 / n sum r exp(-i o theta)| over
/// the bins that were visited; where these do not fill a turn of the joint, neighbouring orders leak into each other.
class ResidualSpectrum
{
public:
  static constexpr double MAX_ORDER = 16.0;

  explicit ResidualSpectrum(double ratio);

  /// `angle` and `speed` of the joint [rad], [rad/s].
  void add(double angle, double speed, double residual);

  /// At every whole order of the joint's turn; amplitudes in the residual's unit. Empty: less than a motor turn was
  /// visited.
  std::vector<SpectrumLine> lines() const;

private:
  static constexpr int BINS_PER_MOTOR_TURN = 128;
  struct Bin
  {
    double sum{};
    double rows{};
  };

  double ratio_;
  std::array<std::vector<Bin>, 2> bins_;  // over one turn of the joint: backward, forward
};
}  // namespace hjt
