// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

namespace hjt
{
/// Time of a message or of a simulated instant [ns since the epoch of the messages].
using Stamp = std::int64_t;

/// Longest stamp difference [ns]: it can still be added to any time that a message can have.
constexpr Stamp MAX_STAMP_LENGTH = std::numeric_limits<Stamp>::max() / 2;

/// Largest magnitude of a stamp that a MAX_STAMP_LENGTH is added to [ns]; messages stay below.
constexpr Stamp MAX_STAMP = std::numeric_limits<Stamp>::max() / 2;

/// A stamp further from the clock than this is damaged, or of a clock that was never set [ns]: a day.
constexpr Stamp FAR_STAMP = 86'400'000'000'000;

/// Whether a stamp is within +-MAX_STAMP.
constexpr bool isStamp(Stamp stamp)
{
  return stamp >= -MAX_STAMP && stamp <= MAX_STAMP;
}

/// Stamp difference [ns] of a duration [s], >= 0; MAX_STAMP_LENGTH for what is longer, and for NaN.
inline Stamp toStampLength(double duration)
{
  const double length = duration * 1e9 + 0.5;
  return length < static_cast<double>(MAX_STAMP_LENGTH) ? static_cast<Stamp>(length) : MAX_STAMP_LENGTH;
}

/// Duration [s] of a stamp difference [ns].
inline double toSeconds(Stamp length)
{
  return static_cast<double>(length) / 1e9;
}
}  // namespace hjt
