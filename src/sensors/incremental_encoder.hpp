// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Optical encoder on the motor shaft: counts up and down without end from the angle at reset.
///
/// Law:   n = floor(theta / q),  q = 2 pi / C
/// where  theta  motor angle since reset                                             [rad]
///        C      counts per turn after quadrature: four times the lines of the disc  [-]
///        n      count, since reset                                                  [counts]
class IncrementalEncoder
{
public:
  explicit IncrementalEncoder(const SensorParameters& parameters)
    : counts_per_radian_(parameters.motor_counts_per_turn / TWO_PI), quantum_(TWO_PI / parameters.motor_counts_per_turn)
  {
  }

  std::int64_t count(double motor_angle) const noexcept
  {
    return static_cast<std::int64_t>(std::floor(motor_angle * counts_per_radian_));
  }

  /// Angle at which the encoder changed to this count from below [rad].
  double angle(std::int64_t count) const noexcept { return static_cast<double>(count) * quantum_; }

private:
  double counts_per_radian_;
  double quantum_;  // one count [rad]
};
}  // namespace hjt
