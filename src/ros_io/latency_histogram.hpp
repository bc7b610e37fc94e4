// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
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
  static constexpr int BINS_PER_OCTAVE = 8;
  static constexpr int FIRST_OCTAVE = 10;  ///< below 2^10 ns everything falls into the first bin
  static constexpr int END_OCTAVE = 34;    ///< beyond 2^34 ns everything falls into the last
  static constexpr std::size_t BIN_COUNT = 1 + BINS_PER_OCTAVE * (END_OCTAVE - FIRST_OCTAVE);

  /// @param latency [ns]; less than zero counts as zero.
  void add(Stamp latency) noexcept;

  std::uint64_t count() const noexcept { return count_; }
  Stamp largest() const noexcept { return largest_; }  ///< [ns]

  /// Latency [ns] that `share` (0 ... 1) of those counted do not exceed, rounded up to the end of its bin; 0 if there
  /// are none.
  Stamp quantile(double share) const noexcept;

  const std::array<std::uint64_t, BIN_COUNT>& bins() const noexcept { return bins_; }

  /// Where a bin ends and the next begins [ns].
  static Stamp binEnd(std::size_t bin) noexcept;

private:
  std::array<std::uint64_t, BIN_COUNT> bins_{};
  std::uint64_t count_{};
  Stamp largest_{};
};
}  // namespace hjt
