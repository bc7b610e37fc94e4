// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

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
  explicit IncrementalEncoder(const SensorParameters& parameters);

  std::int64_t count(double motor_angle) const noexcept;

  /// Angle at which the encoder changed to this count from below [rad].
  double angle(std::int64_t count) const noexcept;

private:
  double counts_per_radian_;
  double quantum_;  // one count [rad]
};
}  // namespace hjt
