// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "base/philox.hpp"
#include "gear/angle.hpp"

namespace hjt
{
/// Pairs of independent standard normal numbers, each a function of seed, channel and index alone: whatever is asked
/// for first, a reading has the same noise live, replayed, offline and on any number of threads.
///
/// Philox4x32-10 (Salmon, Moraes, Dror, Shaw: Parallel random numbers, as easy as 1, 2, 3. SC 2011), then Box and
/// Muller.
class CounterNoise
{
public:
  explicit CounterNoise(std::uint32_t seed) : seed_(seed) {}

  /// [-]
  std::array<double, 2> normals(std::uint32_t channel, std::int64_t index) const noexcept
  {
    const auto counter = static_cast<std::uint64_t>(index);
    const std::array<std::uint32_t, 4> words = philox(
        { static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32), 0, 0 }, { seed_, channel });
    const double radius = std::sqrt(-2.0 * std::log(unitInterval(words[0], words[1])));
    const double angle = TWO_PI * unitInterval(words[2], words[3]);
    return { radius * std::cos(angle), radius * std::sin(angle) };
  }

private:
  /// Two words as a number in (0, 1).
  static double unitInterval(std::uint32_t high, std::uint32_t low) noexcept
  {
    constexpr double STEP = 1.0 / 9007199254740992.0;  // 2^-53
    const std::uint64_t word = (std::uint64_t{ high } << 32) | low;
    return (static_cast<double>(word >> 11) + 0.5) * STEP;
  }

  std::uint32_t seed_;
};
}  // namespace hjt
