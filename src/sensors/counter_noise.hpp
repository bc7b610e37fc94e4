// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

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

  std::array<double, 2> normals(std::uint32_t channel, std::int64_t index) const noexcept;  ///< [-]

private:
  std::uint32_t seed_;
};
}  // namespace hjt
