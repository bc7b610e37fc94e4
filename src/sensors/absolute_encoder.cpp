// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/absolute_encoder.hpp"

#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
AbsoluteEncoder::AbsoluteEncoder(const SensorParameters& parameters)
  : counts_per_turn_(std::int64_t{ 1 } << parameters.output_bits)
  , quantum_(TWO_PI / static_cast<double>(counts_per_turn_))
{
}

std::uint32_t AbsoluteEncoder::count(double output_angle) const noexcept
{
  const std::int64_t in_turn = stepsFromZero(output_angle) % counts_per_turn_;
  return static_cast<std::uint32_t>(in_turn < 0 ? in_turn + counts_per_turn_ : in_turn);
}

double AbsoluteEncoder::unwrappedAngle(double output_angle) const noexcept
{
  return static_cast<double>(stepsFromZero(output_angle)) * quantum_;
}

std::int64_t AbsoluteEncoder::stepsFromZero(double output_angle) const noexcept
{
  return static_cast<std::int64_t>(std::floor(output_angle / TWO_PI * static_cast<double>(counts_per_turn_)));
}
}  // namespace hjt
