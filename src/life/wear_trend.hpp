// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hjt
{
/// Errors of the readings of one kind of wear.
struct ReadingErrors
{
  double gain;         ///< standard deviation of the relative gain error, which is constant for a drive [-]
  double offset;       ///< standard deviation of the offset as a severity; the offset is constant for a drive [-]
  double noise;        ///< constant part of a reading's noise, as a severity: standard deviation [-]
  double noise_share;  ///< part of a reading's noise in proportion to the reading: standard deviation over reading [-]
};

/// Severities of equivalent wear depths (LoadFeedback): reading of a drive, and nominal drive after equal use [-].
struct WearPoint
{
  double nominal;
  double reading;
};

/// Rate of wear of a drive, from readings over its use.
///
/// Law:   r_i = g u_i + d + n_i,   g = f (1 + b),   n_i^2 = a^2 + (c r_i)^2 + (v (r - r_i))^2
/// where  u, r  severities of nominal drive and reading of WearPoint i; r without index: of the last WearPoint
///        f     wear of the drive over that of the nominal drive;  b, d  errors of gain and offset, normal about 0
///        a, c  ReadingErrors::noise, noise_share;  v  RATE_SCATTER, because the rate may have changed since reading i
/// The likelihood is integrated over d; g is normal.
class WearTrend
{
public:
  WearTrend() = default;
  WearTrend(const std::vector<WearPoint>& points, const ReadingErrors& errors, double rate_scatter)
    : is_known_(!points.empty()), gain_(errors.gain), ones_(1.0 / (errors.offset * errors.offset))
  {
    double squares = 0.0;
    double products = 0.0;
    for (const WearPoint& point : points)
    {
      const double since = rate_scatter * (points.back().reading - point.reading);
      const double share = errors.noise_share * point.reading;
      const double weight = 1.0 / (errors.noise * errors.noise + share * share + since * since);
      squares += weight * point.nominal * point.nominal;
      products += weight * point.nominal * point.reading;
      nominals_ += weight * point.nominal;
      readings_ += weight * point.reading;
      ones_ += weight;
    }
    const double precision = squares - nominals_ * nominals_ / ones_;
    is_known_ = is_known_ && precision > 0.0;
    growth_ = is_known_ ? (products - nominals_ * readings_ / ones_) / precision : 0.0;
    variance_ = is_known_ ? 1.0 / precision : 0.0;
  }

  bool isKnown() const noexcept { return is_known_; }

  /// Logarithm of the readings' probability density for a drive with the factor f, up to a constant.
  double logDensity(double factor) const noexcept
  {
    const double variance = variance_ + gain_ * gain_ * factor * factor;
    const double off = growth_ - factor;
    return -0.5 * (off * off / variance + std::log(variance));
  }

  /// Severity of the nominal drive's wear when a drive with the factor f will have the reading `reading`. `by_gain`,
  /// `by_offset`: standard normal deviates of the errors of gain and offset.
  double nominalAt(double reading, double factor, double by_gain, double by_offset) const noexcept
  {
    const double prior = gain_ * gain_ * factor * factor;
    const double left = variance_ * prior / (variance_ + prior);
    const double growth = (growth_ * prior + factor * variance_) / (variance_ + prior) + std::sqrt(left) * by_gain;
    const double offset = (readings_ - nominals_ * growth) / ones_ + by_offset / std::sqrt(ones_);
    return growth > 0.0 ? (reading - offset) / growth : HUGE_VAL;
  }

private:
  bool is_known_{};
  double gain_{};
  double growth_{};
  double variance_{};
  double nominals_{};
  double readings_{};
  double ones_{};
};

/// Trends of flank wear and interface wear, from readings.
struct WearTrends
{
  WearTrend flank;
  WearTrend interface;
  double flank_depth{ 1.0 };          ///< flank wear depth at severity 1 [m]
  double reading_at_end{ HUGE_VAL };  ///< reading of the flanks at which the lost motion ends the drive's use [-]
};

/// Wear changes the loads that cause wear. The equivalent wear depth is the depth that equal use would cause with the
/// loads of the new drive. This class gives it as a function of the real wear depth, linear between and beyond nodes.
class LoadFeedback
{
public:
  static constexpr std::size_t NODES = 9;

  /// @param farthest depth of the last node [m]
  /// @param rate_at rate of wear at a depth, over the rate of the new drive [-]
  template <class RateAt>
  LoadFeedback(double farthest, RateAt&& rate_at) : step_(farthest / static_cast<double>(NODES - 1))
  {
    double before = 1.0 / rate_at(0.0);
    for (std::size_t i = 1; i < NODES; ++i)
    {
      const double here = 1.0 / rate_at(step_ * static_cast<double>(i));
      fresh_[i] = fresh_[i - 1] + 0.5 * step_ * (before + here);
      before = here;
    }
  }

  double of(double depth) const noexcept
  {
    const double at = depth / step_;
    const double stretch = std::fmin(std::fmax(std::floor(at), 0.0), static_cast<double>(NODES - 2));
    const auto i = static_cast<std::size_t>(stretch);
    return fresh_[i] + (at - stretch) * (fresh_[i + 1] - fresh_[i]);
  }

private:
  double step_;
  std::array<double, NODES> fresh_{};
};
}  // namespace hjt
