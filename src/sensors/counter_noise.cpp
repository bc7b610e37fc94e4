// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/counter_noise.hpp"

#include <cmath>

#include "base/philox.hpp"
#include "gear/angle.hpp"

namespace hjt
{
namespace
{
/// Two words as a number in (0, 1).
double unitInterval(std::uint32_t high, std::uint32_t low) noexcept
{
  constexpr double STEP = 1.0 / 9007199254740992.0;  // 2^-53
  const std::uint64_t word = (std::uint64_t{ high } << 32) | low;
  return (static_cast<double>(word >> 11) + 0.5) * STEP;
}
}  // namespace

std::array<double, 2> CounterNoise::normals(std::uint32_t channel, std::int64_t index) const noexcept
{
  const auto counter = static_cast<std::uint64_t>(index);
  const std::array<std::uint32_t, 4> words = philox(
      { static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32), 0, 0 }, { seed_, channel });
  const double radius = std::sqrt(-2.0 * std::log(unitInterval(words[0], words[1])));
  const double angle = TWO_PI * unitInterval(words[2], words[3]);
  return { radius * std::cos(angle), radius * std::sin(angle) };
}
}  // namespace hjt
