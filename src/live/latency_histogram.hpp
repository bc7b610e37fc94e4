// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "harmonic_joint_twin/twin/input_queue.hpp"

namespace hjt
{
/// Counts latencies in bins of fixed relative width, eight to a doubling, from a microsecond to 17 s. Fixed size:
/// adding allocates nothing and costs the same whatever comes.
class LatencyHistogram
{
public:
  static constexpr int BIN_BITS = 3;  ///< of a latency, below its leading one, that choose the bin within the octave
  static constexpr int BINS_PER_OCTAVE = 1 << BIN_BITS;
  static constexpr int FIRST_OCTAVE = 10;  ///< below 2^10 ns everything falls into the first bin
  static constexpr int END_OCTAVE = 34;    ///< beyond 2^34 ns everything falls into the last
  static constexpr std::size_t BIN_COUNT = 1 + BINS_PER_OCTAVE * (END_OCTAVE - FIRST_OCTAVE);

  /// @param latency [ns]; less than zero counts as zero.
  void add(Stamp latency) noexcept
  {
    ++bins_[binOf(latency)];
    ++count_;
    largest_ = std::max(largest_, latency);
  }

  std::uint64_t count() const noexcept { return count_; }
  Stamp largest() const noexcept { return largest_; }  ///< [ns]

  /// Latency [ns] that `share` (0 ... 1) of those counted do not exceed, rounded up to the end of its bin; 0 if there
  /// are none.
  Stamp quantile(double share) const noexcept
  {
    std::uint64_t counted = 0;
    for (std::size_t bin = 0; bin < BIN_COUNT; ++bin)
    {
      counted += bins_[bin];
      if (counted > 0 && static_cast<double>(counted) >= share * static_cast<double>(count_))
      {
        return std::min(binEnd(bin), largest_);
      }
    }
    return 0;
  }

  const std::array<std::uint64_t, BIN_COUNT>& bins() const noexcept { return bins_; }

  /// Upper end of a bin [ns].
  static Stamp binEnd(std::size_t bin) noexcept
  {
    const auto octave = static_cast<int>(FIRST_OCTAVE * BINS_PER_OCTAVE + bin) / BINS_PER_OCTAVE;
    const auto within = static_cast<Stamp>(bin % BINS_PER_OCTAVE);
    return (BINS_PER_OCTAVE + within) << (octave - BIN_BITS);
  }

private:
  static std::size_t binOf(Stamp latency) noexcept
  {
    const int octave = latency > 0 ? std::ilogb(static_cast<double>(latency)) : 0;
    if (octave < FIRST_OCTAVE)
    {
      return 0;
    }
    const Stamp within = (latency >> (octave - BIN_BITS)) - BINS_PER_OCTAVE;
    const Stamp bin = 1 + (octave - FIRST_OCTAVE) * BINS_PER_OCTAVE + within;
    return std::min(static_cast<std::size_t>(bin), BIN_COUNT - 1);
  }

  std::array<std::uint64_t, BIN_COUNT> bins_{};
  std::uint64_t count_{};
  Stamp largest_{};
};
}  // namespace hjt
