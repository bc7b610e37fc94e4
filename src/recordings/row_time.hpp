// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt
{
/// Times of a recording's rows from its first row on [s].
///
/// Stamps that jump back, of a recording played in a loop, or ahead by more than a day, from before there was a time,
/// begin another round: it counts from BETWEEN after the one before, a gap that cuts the stream.
class RowTime
{
public:
  static constexpr double BACK = 1.0;       ///< less than this is a row out of order [s]
  static constexpr double AHEAD = 86400.0;  ///< [s]
  static constexpr double BETWEEN = 1.0;    ///< [s]

  double at(Stamp stamp)
  {
    if (!last_)
    {
      last_ = stamp;
      zero_ = start_ = stamp;
    }
    const double step = toSeconds(stamp - *last_);
    if (step < -BACK || step > AHEAD)
    {
      zero_ = stamp;
      offset_ = time_ + BETWEEN;
      ++rounds_;
    }
    last_ = stamp;
    const double time = offset_ + toSeconds(stamp - zero_);
    time_ = time > time_ ? time : time_;
    return time;
  }

  /// As received, beside the stamp that `at` was given last.
  double received(Stamp recorded) const { return offset_ + toSeconds(recorded - zero_); }

  std::uint64_t rounds() const { return rounds_; }
  Stamp start() const { return start_; }

private:
  std::optional<Stamp> last_;
  Stamp zero_{};
  Stamp start_{};
  double offset_{};
  double time_{};
  std::uint64_t rounds_{ 1 };
};
}  // namespace hjt
