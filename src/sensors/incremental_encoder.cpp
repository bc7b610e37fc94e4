// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/incremental_encoder.hpp"

#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
IncrementalEncoder::IncrementalEncoder(const SensorParameters& parameters)
  : counts_per_radian_(parameters.motor_counts_per_turn / TWO_PI), quantum_(TWO_PI / parameters.motor_counts_per_turn)
{
}

std::int64_t IncrementalEncoder::count(double motor_angle) const noexcept
{
  return static_cast<std::int64_t>(std::floor(motor_angle * counts_per_radian_));
}

double IncrementalEncoder::angle(std::int64_t count) const noexcept
{
  return static_cast<double>(count) * quantum_;
}
}  // namespace hjt
