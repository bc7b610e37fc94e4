// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

namespace hjt
{
/// Time of a message or of a simulated instant [ns], counted from the epoch of ROS messages.
using Stamp = std::int64_t;

/// Largest difference between two stamps [ns]. Its sum with any stamp of a message does not overflow.
constexpr Stamp MAX_STAMP_LENGTH = std::numeric_limits<Stamp>::max() / 2;

/// Largest magnitude of a stamp [ns]. Its sum with MAX_STAMP_LENGTH does not overflow.
constexpr Stamp MAX_STAMP = std::numeric_limits<Stamp>::max() / 2;

/// Largest plausible difference between a stamp and the clock: one day [ns]. If a stamp differs more, the stamp is
/// damaged, or its clock was never set.
constexpr Stamp FAR_STAMP = 86'400'000'000'000;

/// Whether a stamp is between -MAX_STAMP and MAX_STAMP.
constexpr bool isStamp(Stamp stamp)
{
  return stamp >= -MAX_STAMP && stamp <= MAX_STAMP;
}

/// Converts a duration >= 0 [s] to a stamp difference [ns]. The result is at most MAX_STAMP_LENGTH, also for a NaN.
inline Stamp toStampLength(double duration)
{
  const double length = duration * 1e9 + 0.5;
  return length < static_cast<double>(MAX_STAMP_LENGTH) ? static_cast<Stamp>(length) : MAX_STAMP_LENGTH;
}

/// Converts a stamp difference [ns] to a duration [s].
inline double toSeconds(Stamp length)
{
  return static_cast<double>(length) / 1e9;
}
}  // namespace hjt
