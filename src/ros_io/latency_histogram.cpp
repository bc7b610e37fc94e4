// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
/// Bits of a latency, below its leading one, that choose the bin within the octave.
constexpr int BIN_BITS = 3;
static_assert(1 << BIN_BITS == LatencyHistogram::BINS_PER_OCTAVE, "bins of an octave are counted in bits");

std::size_t binOf(Stamp latency) noexcept
{
  const int octave = latency > 0 ? std::ilogb(static_cast<double>(latency)) : 0;
  if (octave < LatencyHistogram::FIRST_OCTAVE)
  {
    return 0;
  }
  const Stamp within = (latency >> (octave - BIN_BITS)) - LatencyHistogram::BINS_PER_OCTAVE;
  const Stamp bin = 1 + (octave - LatencyHistogram::FIRST_OCTAVE) * LatencyHistogram::BINS_PER_OCTAVE + within;
  return std::min(static_cast<std::size_t>(bin), LatencyHistogram::BIN_COUNT - 1);
}
}  // namespace

void LatencyHistogram::add(Stamp latency) noexcept
{
  ++bins_[binOf(latency)];
  ++count_;
  largest_ = std::max(largest_, latency);
}

Stamp LatencyHistogram::quantile(double share) const noexcept
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

Stamp LatencyHistogram::binEnd(std::size_t bin) noexcept
{
  const auto octave = static_cast<int>(FIRST_OCTAVE * BINS_PER_OCTAVE + bin) / BINS_PER_OCTAVE;
  const auto within = static_cast<Stamp>(bin % BINS_PER_OCTAVE);
  return (BINS_PER_OCTAVE + within) << (octave - BIN_BITS);
}
}  // namespace hjt
