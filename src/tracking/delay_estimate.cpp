// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/delay_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
constexpr double MAX_GAP = 0.1;      // beyond it the stream restarts [s]
constexpr double MIN_SECONDS = 2.0;  // of signal before a delay is given
}  // namespace

void DelayEstimate::add(double time, double leading, double lagging) noexcept
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

double DelayEstimate::correlation(std::size_t lag) const noexcept
{
  const double power = leading_power_[lag] * lagging_power_;
  return power > 0.0 ? products_[lag] / std::sqrt(power) : 0.0;
}

std::optional<double> DelayEstimate::lag() const noexcept
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
}  // namespace hjt
