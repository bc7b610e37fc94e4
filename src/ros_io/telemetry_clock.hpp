// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdlib>
#include <optional>

#include "messages/time.hpp"

namespace hjt
{
/// Zero of a robot's telemetry, the stamp of its first row, and whether stamps are of the same clock.
class TelemetryClock
{
public:
  enum class Row
  {
    TAKEN,
    FIRST,    ///< sets the zero
    MOVED,    ///< the clock of the robot or this machine's was set: a new zero
    REFUSED,  ///< far from where the rows before lead to; the next one like it counts as MOVED
  };

  Row take(Stamp stamp, Stamp received)
  {
    const Stamp offset = received - stamp;
    const bool moved = zero_ && !agree(offset, offset_);
    if (moved && !(refused_offset_ && agree(offset, *refused_offset_)))
    {
      refused_offset_ = offset;
      return Row::REFUSED;
    }
    const bool first = !zero_;
    refused_offset_.reset();
    offset_ = offset;
    if (first || moved)
    {
      zero_ = stamp;
    }
    return moved ? Row::MOVED : first ? Row::FIRST : Row::TAKEN;
  }

  bool hasStarted() const { return zero_.has_value(); }
  double seconds(Stamp stamp) const { return toSeconds(stamp - *zero_); }
  Stamp stamp(double seconds) const { return *zero_ + std::llround(1e9 * seconds); }

  /// Time of this clock at a time of reception [ns].
  Stamp at(Stamp received) const { return received - offset_; }
  /// Whether a stamp received then can be of this clock.
  bool isOf(Stamp stamp, Stamp received) const { return agree(received - stamp, offset_); }

private:
  static bool agree(Stamp a, Stamp b) { return std::abs(a - b) <= FAR_STAMP; }

  std::optional<Stamp> zero_;            // [ns]
  Stamp offset_{};                       // of the last row taken: reception less stamp [ns]
  std::optional<Stamp> refused_offset_;  // of the last row, if its stamp was refused [ns]
};
}  // namespace hjt
