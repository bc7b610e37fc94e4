// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "tracking/friction_verdict.hpp"

namespace hjt
{
/// Friction of a joint in one of several recordings.
struct DatedFriction
{
  double time{};            ///< in any unit
  double factor{};          ///< > 0 [-]
  double deviation{};       ///< standard deviation of its logarithm, > 0 [-]
  double slow_deviation{};  ///< the part of it that may last for a season: of the temperature [-]
};

/// A line through the logarithms of a joint's friction over time, each weighted by its deviation. Where the factors
/// scatter more than their deviations say, their scatter counts. What is slow does not average out: it counts as if it
/// were of one sign in the first half and of the other in the second.
struct FrictionTrend
{
  static constexpr std::size_t MIN_RECORDINGS = 4;  ///< two make any line; the others have to agree with it

  std::size_t recordings{};
  double span{};                                             ///< of their times
  double slope{ std::numeric_limits<double>::quiet_NaN() };  ///< of the logarithm, in 1 / unit of time; NaN: not known
  double deviation{};                                        ///< standard deviation of the slope

  bool isKnown() const { return std::isfinite(slope); }

  // 95 % intervals.
  double slopeLow() const { return slope - halfWidth(); }
  double slopeHigh() const { return slope + halfWidth(); }
  double change() const { return std::exp(slope * span); }  ///< friction at the end over that at the beginning [-]
  double changeLow() const { return std::exp(slopeLow() * span); }
  double changeHigh() const { return std::exp(slopeHigh() * span); }

  /// The whole interval of the change is beyond what counts as a change of a joint's own friction.
  bool departs() const { return changeLow() > 1.0 + MORE_THAN_OWN || changeHigh() < 1.0 - LESS_THAN_OWN; }

private:
  double halfWidth() const
  {
    constexpr double NORMAL_95 = 1.96;
    return NORMAL_95 * deviation;
  }
};

/// Not known: fewer than MIN_RECORDINGS, or no time between them.
inline FrictionTrend frictionTrend(const std::vector<DatedFriction>& recordings)
{
  FrictionTrend trend;
  trend.recordings = recordings.size();
  if (recordings.empty())
  {
    return trend;
  }
  const auto is_earlier = [](const DatedFriction& a, const DatedFriction& b) { return a.time < b.time; };
  const auto [first, last] = std::minmax_element(recordings.begin(), recordings.end(), is_earlier);
  trend.span = last->time - first->time;
  if (trend.recordings < FrictionTrend::MIN_RECORDINGS || !(trend.span > 0.0))
  {
    return trend;
  }
  double weights = 0.0;
  double time = 0.0;
  double logarithm = 0.0;
  for (const DatedFriction& recording : recordings)
  {
    const double weight = 1.0 / (recording.deviation * recording.deviation);
    weights += weight;
    time += weight * recording.time;
    logarithm += weight * std::log(recording.factor);
  }
  time /= weights;
  logarithm /= weights;
  double squares = 0.0;
  double products = 0.0;
  for (const DatedFriction& recording : recordings)
  {
    const double weight = 1.0 / (recording.deviation * recording.deviation);
    squares += weight * std::pow(recording.time - time, 2);
    products += weight * (recording.time - time) * (std::log(recording.factor) - logarithm);
  }
  trend.slope = products / squares;
  double left = 0.0;  // over what the deviations allow, squared
  double fast = 0.0;  // variance of the slope
  double slow = 0.0;
  for (const DatedFriction& recording : recordings)
  {
    const double part = (recording.time - time) / (recording.deviation * recording.deviation * squares);
    fast += part * part * (std::pow(recording.deviation, 2) - std::pow(recording.slow_deviation, 2));
    slow += std::abs(part) * recording.slow_deviation;
    const double rest = std::log(recording.factor) - logarithm - trend.slope * (recording.time - time);
    left += std::pow(rest / recording.deviation, 2);
  }
  const double scatter = std::max(1.0, left / static_cast<double>(trend.recordings - 2));
  trend.deviation = std::sqrt(scatter * std::max(0.0, fast) + slow * slow);
  return trend;
}
}  // namespace hjt
