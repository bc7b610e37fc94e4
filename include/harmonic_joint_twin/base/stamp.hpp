// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace hjt
{
/// Time of a message or of a simulated instant [ns since the epoch of the messages].
using Stamp = std::int64_t;

/// Stamp difference [ns] of a duration [s], >= 0.
inline Stamp toStampLength(double duration)
{
  return static_cast<Stamp>(duration * 1e9 + 0.5);
}

/// Duration [s] of a stamp difference [ns].
inline double toSeconds(Stamp length)
{
  return static_cast<double>(length) / 1e9;
}
}  // namespace hjt
