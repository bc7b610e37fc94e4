// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt
{
/// Times of a recording's rows from its first row on [s].
///
/// Stamps that jump back, of a recording played in a loop, or ahead by more than a day, from before there was a time,
/// begin another round: it counts from BETWEEN after the one before, a gap that cuts the stream. So does a clock that
/// was set back by less: MOST_BEHIND rows in order among themselves, all behind an earlier one. Rows that are days
/// apart one after the other have stamps of another unit, and no rounds.
class RowTime
{
public:
  static constexpr double BACK = 1.0;       ///< less than this is a row out of order [s]
  static constexpr double AHEAD = 86400.0;  ///< [s]
  static constexpr double BETWEEN = 1.0;    ///< [s]
  static constexpr std::uint64_t MOST_AHEAD = 10;
  static constexpr std::uint64_t MOST_BEHIND = 10;

  double at(Stamp stamp)
  {
    if (!last_)
    {
      last_ = stamp;
      zero_ = start_ = stamp;
    }
    const double step = toSeconds(stamp - *last_);
    ahead_ += step > AHEAD ? 1 : 0;
    behind_ = step > 0.0 && offset_ + toSeconds(stamp - zero_) < time_ ? behind_ + 1 : 0;
    if (step < -BACK || (step > AHEAD && ahead_ <= MOST_AHEAD) || behind_ > MOST_BEHIND)
    {
      zero_ = stamp;
      offset_ = time_ + BETWEEN;
      behind_ = 0;
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
  std::uint64_t ahead_{};
  std::uint64_t behind_{};
};

/// Do the rows come in the order of their stamps?
class RowOrder
{
public:
  void add(double stamp)
  {
    if (rows_++ > 0)
    {
      back_ += stamp < last_ ? 1 : 0;
      same_ += stamp == last_ ? 1 : 0;
    }
    last_ = stamp;
  }

  /// The deviation as a clause; empty: the times agree, or nearly.
  std::string text() const
  {
    constexpr std::uint64_t FEWEST = 10;
    constexpr std::uint64_t MOST = 5;    // rows for one that goes back
    constexpr std::uint64_t COPIES = 9;  // most copies of one row
    if (rows_ < FEWEST)
    {
      return {};
    }
    if (same_ + 1 == rows_)
    {
      return "all rows have the same stamp: times, speeds and loads are unknown";
    }
    if (COPIES * same_ > (COPIES - 1) * rows_)
    {
      return "the stamps are rounded: " + std::to_string(same_) + " of " + std::to_string(rows_) +
             " rows have that of the row before, so times, speeds and loads are unknown";
    }
    return MOST * back_ > rows_ ? "the rows are not in the order of their stamps: " + std::to_string(back_) + " of " +
                                      std::to_string(rows_) + " go back" :
                                  std::string();
  }

private:
  double last_{};
  std::uint64_t rows_{};
  std::uint64_t back_{};
  std::uint64_t same_{};
};
}  // namespace hjt
