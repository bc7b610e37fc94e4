// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <boost/math/special_functions/erf.hpp>

#include "life/wear_trend.hpp"

namespace hjt
{
constexpr double FARTHEST = 30.0;  // standard deviations: the normal distribution ends where doubles do

inline double squared(double value)
{
  return value * value;
}

inline double normalShare(double deviation) noexcept
{
  return 0.5 * std::erfc(-deviation / std::sqrt(2.0));
}

/// The deviation below `most` of which a share `share` of the normal distribution's part below `most` lies.
inline double normalBelow(double most, double share) noexcept
{
  const double part = share * normalShare(std::clamp(most, -FARTHEST, FARTHEST));
  return -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * std::clamp(part, 1e-300, 1.0 - 1e-16));
}

/// Factor, log-normal about 1, of a drive that `ends_at` or more would have ended.
inline double factorBelow(double ends_at, double spread, double share) noexcept
{
  return spread > 0.0 ? std::exp(spread * normalBelow(std::log(ends_at) / spread, share)) : 1.0;
}

/// Standard normal deviate of a share of all.
inline double normalAt(double share) noexcept
{
  return normalBelow(FARTHEST, share);
}

/// Factors of wear, as a table of their distribution.
class FactorTable
{
public:
  /// Given the readings, of a drive that `ends_at` or more would have ended. `spread`: of the logarithm beforehand.
  void given(const WearTrend& trend, double spread, double ends_at) noexcept
  {
    constexpr double REACH = 6.5;  // standard deviations
    is_read_ = trend.isKnown() && spread > 0.0;
    spread_ = spread;
    ends_at_ = ends_at;
    if (!is_read_)
    {
      return;
    }
    const double last = std::clamp(std::log(ends_at) / spread, 1e-3 - REACH, REACH);
    first_ = -REACH * spread;
    step_ = (last + REACH) * spread / static_cast<double>(NODES - 1);
    double largest = -HUGE_VAL;
    for (std::size_t i = 0; i < NODES; ++i)
    {
      const double logarithm = first_ + step_ * static_cast<double>(i);
      reached_[i] = trend.logDensity(std::exp(logarithm)) - 0.5 * squared(logarithm / spread);
      largest = std::max(largest, reached_[i]);
    }
    double before = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < NODES; ++i)
    {
      const double here = std::exp(reached_[i] - largest);
      sum += i == 0 ? 0.0 : before + here;
      before = here;
      reached_[i] = sum;
    }
    std::transform(reached_.begin(), reached_.end(), reached_.begin(), [sum](double value) { return value / sum; });
  }

  double drawn(double share) const noexcept
  {
    if (!is_read_)
    {
      return factorBelow(ends_at_, spread_, share);
    }
    const auto after = std::lower_bound(reached_.begin() + 1, reached_.end() - 1, share);
    const double stretch = *after - *(after - 1);
    const double part = stretch > 0.0 ? (share - *(after - 1)) / stretch : 0.5;
    return std::exp(first_ + step_ * (static_cast<double>(after - 1 - reached_.begin()) + part));
  }

private:
  static constexpr std::size_t NODES = 4096;

  std::vector<double> reached_ = std::vector<double>(NODES);  // share of the distribution up to each node
  double first_{};                                            // logarithm of the first node's factor
  double step_{};
  double spread_{};
  double ends_at_{};
  bool is_read_{};
};
}  // namespace hjt
