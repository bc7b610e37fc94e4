// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace hjt
{
/// By how much one signal of a stream lags behind another: where their cross-correlation is largest.
///
/// Both pass the same high-pass; products are summed for lags on a grid up to LONGEST to either side and forgotten over
/// MEMORY; a parabola through the largest three gives what lies between. Fixed memory; nothing allocates.
class DelayEstimate
{
public:
  static constexpr double LONGEST = 0.1;          ///< [s]
  static constexpr double GRID = 0.004;           ///< between lags tried [s]
  static constexpr double MEMORY = 20.0;          ///< [s]
  static constexpr double MIN_CORRELATION = 0.7;  ///< below it no delay is given [-]

  void reset() noexcept { *this = DelayEstimate(); }

  /// A row of both, later than the one before [s].
  void add(double time, double leading, double lagging) noexcept
  {
    const bool first = end_ == begin_ || time > at(end_ - 1).time + MAX_GAP;
    const double step = first ? 0.0 : time - at(end_ - 1).time;
    if (first)
    {
      begin_ = end_;
      leading_mean_ = leading;
      lagging_mean_ = lagging;
    }
    const double fresh = 1.0 - std::exp(-step / SLOWEST);
    leading_mean_ += fresh * (leading - leading_mean_);
    lagging_mean_ += fresh * (lagging - lagging_mean_);
    rows_[end_ % ROOM] = { time, leading - leading_mean_, lagging - lagging_mean_ };
    ++end_;

    // The lagging signal is taken in the middle of what is held, so that the leading one is known to either side.
    const double middle = time - LONGEST;
    const std::uint64_t oldest = std::max(begin_, end_ > ROOM ? end_ - ROOM : 0);
    if (at(oldest).time > middle - LONGEST)
    {
      return;
    }
    std::uint64_t above = end_ - 1;
    const auto interpolate = [&](double when, double Row::*signal)
    {
      while (above > oldest + 1 && at(above - 1).time > when)
      {
        --above;
      }
      const Row& high = at(above);
      const Row& low = at(above - 1);
      return low.*signal + (high.*signal - low.*signal) * (when - low.time) / (high.time - low.time);
    };
    const double later = interpolate(middle, &Row::lagging);
    const double kept = std::exp(-step / MEMORY);
    seconds_ = kept * seconds_ + step;
    lagging_power_ = kept * lagging_power_ + step * later * later;
    above = end_ - 1;
    for (std::size_t i = 0; i < LAGS; ++i)
    {
      const double earlier = interpolate(middle - GRID * (static_cast<double>(i) - HALF), &Row::leading);
      products_[i] = kept * products_[i] + step * later * earlier;
      leading_power_[i] = kept * leading_power_[i] + step * earlier * earlier;
    }
  }

  /// Of the lagging signal, > 0: it comes later [s]. Nothing: too little alike, or the largest lies at the end.
  std::optional<double> lag() const noexcept
  {
    std::size_t best = 0;
    for (std::size_t i = 1; i < LAGS; ++i)
    {
      best = correlation(i) > correlation(best) ? i : best;
    }
    const double peak = correlation(best);
    if (seconds_ < MIN_SECONDS || best == 0 || best + 1 == LAGS || peak < MIN_CORRELATION)
    {
      return std::nullopt;
    }
    const double below = correlation(best - 1);
    const double above = correlation(best + 1);
    const double bend = below - 2.0 * peak + above;
    const double beside = bend < 0.0 ? 0.5 * (below - above) / bend : 0.0;
    return GRID * (static_cast<double>(best) - HALF + beside);
  }

private:
  static constexpr double MAX_GAP = 0.1;      // beyond it the stream restarts [s]
  static constexpr double MIN_SECONDS = 2.0;  // of signal before a delay is given

  static constexpr std::size_t ROOM = 512;
  static constexpr int HALF = 25;  // LONGEST / GRID
  static constexpr std::size_t LAGS = 2 * HALF + 1;
  static constexpr double SLOWEST = 0.5;  // time constant of the high-pass [s]

  struct Row
  {
    double time;
    double leading;
    double lagging;
  };
  const Row& at(std::uint64_t index) const noexcept { return rows_[index % ROOM]; }

  double correlation(std::size_t lag) const noexcept
  {
    const double power = leading_power_[lag] * lagging_power_;
    return power > 0.0 ? products_[lag] / std::sqrt(power) : 0.0;
  }

  std::array<Row, ROOM> rows_{};
  std::uint64_t begin_{};  // first row of the present stretch
  std::uint64_t end_{};
  double leading_mean_{};
  double lagging_mean_{};
  std::array<double, LAGS> products_{};
  std::array<double, LAGS> leading_power_{};
  double lagging_power_{};
  double seconds_{};  // that the sums hold
};
}  // namespace hjt
