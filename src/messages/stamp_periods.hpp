// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>

#include "messages/time.hpp"

namespace hjt
{
/// Periods of a topic, counted from the epoch: the same stamps begin the same periods, live and replayed.
class StampPeriods
{
public:
  explicit StampPeriods(double rate) : length_(toStampLength(1.0 / rate)) {}  ///< [Hz]

  /// Whether a stamp is the first in its period.
  bool begins(Stamp stamp)
  {
    const std::int64_t number = stamp / length_;
    return std::exchange(number_, number) != number;
  }

  std::int64_t number() const { return number_; }  ///< of the last stamp's period

private:
  Stamp length_;  // [ns]
  std::int64_t number_{};
};
}  // namespace hjt
