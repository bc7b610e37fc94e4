// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Absolute encoder at the joint's output: the position within one turn, in N counts.
///
/// Law:   n = floor(phi / q) mod N,  q = 2 pi / N
/// where  phi  output angle                      [rad]
///        N    counts per turn                   [-]
///        n    count, 0 ... N - 1                [counts]
///
/// The count says nothing about whole turns. A drive counts them by watching the count jump, which fails when it looks
/// less than twice a turn; here the turn is taken from the true angle, so that the unwrapped angle is right however
/// seldom it is read.
class AbsoluteEncoder
{
public:
  explicit AbsoluteEncoder(const SensorParameters& parameters)
    : counts_per_turn_(parameters.output_counts_per_turn), quantum_(TWO_PI / static_cast<double>(counts_per_turn_))
  {
  }

  std::uint32_t count(double output_angle) const noexcept
  {
    const std::int64_t in_turn = stepsFromZero(output_angle) % counts_per_turn_;
    return static_cast<std::uint32_t>(in_turn < 0 ? in_turn + counts_per_turn_ : in_turn);
  }

  /// Turns of the true angle plus the count's part of a turn [rad].
  double unwrappedAngle(double output_angle) const noexcept
  {
    return static_cast<double>(stepsFromZero(output_angle)) * quantum_;
  }

private:
  std::int64_t stepsFromZero(double output_angle) const noexcept
  {
    return static_cast<std::int64_t>(std::floor(output_angle / TWO_PI * static_cast<double>(counts_per_turn_)));
  }

  std::int64_t counts_per_turn_;
  double quantum_;  // one count [rad]
};
}  // namespace hjt
