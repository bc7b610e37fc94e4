// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace hjt
{
/// Values with the times from which they are valid, kept for rows that come later. Nothing allocates.
class HeldValues
{
public:
  static constexpr std::size_t ROOM = 512;  ///< older ones are forgotten

  void push(double time, double value) noexcept
  {
    values_[end_ % ROOM] = { time, value };
    ++end_;
  }

  /// The value given last of those not later than `time`; none, or older than `max_age`: nothing. Times in [s].
  std::optional<double> at(double time, double max_age = std::numeric_limits<double>::infinity()) const noexcept
  {
    for (std::uint64_t i = end_; i > begin_ && end_ - i < ROOM; --i)
    {
      const ValueAt& held = values_[(i - 1) % ROOM];
      if (held.time <= time)
      {
        return time - held.time <= max_age ? std::make_optional(held.value) : std::nullopt;
      }
    }
    return std::nullopt;
  }

  void clear() noexcept { begin_ = end_; }

  /// Marks the values pushed so far as those of rows that were received.
  void mark() noexcept { marked_ = end_; }

  /// The time of the rows jumps back: forgets all but what was pushed since the mark from a time before `earliest` on,
  /// which belongs to rows to come.
  void jumpBack(double earliest) noexcept
  {
    begin_ = std::max({ begin_, marked_, end_ > ROOM ? end_ - ROOM : 0 });
    while (begin_ < end_ && values_[begin_ % ROOM].time >= earliest)
    {
      ++begin_;
    }
  }

private:
  struct ValueAt
  {
    double time;
    double value;
  };

  std::array<ValueAt, ROOM> values_{};
  std::uint64_t begin_{};
  std::uint64_t marked_{};
  std::uint64_t end_{};
};

/// Temperatures of one drive as they are received. Bad ones are counted and left out. Nothing allocates.
class TemperatureRecord
{
public:
  /// Older ones are not used. The slowest that a UR's joints warm up with is a time constant of some 1600 s: in this
  /// time by 4 % of the whole rise, which is 1 K or less [s].
  static constexpr double MAX_AGE = 60.0;
  static constexpr double LOWEST = -20.0;  ///< [degC]
  static constexpr double HIGHEST = 120.0;

  static bool isPossible(double temperature) noexcept { return temperature >= LOWEST && temperature <= HIGHEST; }

  /// Keeps a temperature of a time [s] from any zero; refuses one outside LOWEST ... HIGHEST [degC] or not finite.
  void push(double time, double temperature) noexcept
  {
    if (std::isfinite(time) && isPossible(temperature))
    {
      values_.push(time, temperature);
    }
    else
    {
      ++refused_;
    }
  }

  /// The latest one not later than `time` and not older than MAX_AGE; NaN: there is none [degC].
  double at(double time) const noexcept
  {
    return values_.at(time, MAX_AGE).value_or(std::numeric_limits<double>::quiet_NaN());
  }

  void clear() noexcept { values_.clear(); }
  void mark() noexcept { values_.mark(); }                                 ///< as HeldValues
  void jumpBack(double earliest) noexcept { values_.jumpBack(earliest); }  ///< as HeldValues

  std::uint64_t refused() const noexcept { return refused_; }

private:
  HeldValues values_;
  std::uint64_t refused_{};
};
}  // namespace hjt
