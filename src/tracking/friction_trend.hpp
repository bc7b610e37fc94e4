// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "base/statistics.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
/// Friction of a joint in one of several recordings.
struct DatedFriction
{
  double time{};            ///< in any unit
  double factor{};          ///< > 0, apart from common factors of the joints [-]
  double deviation{};       ///< standard deviation of its logarithm, > 0 [-]
  double slow_deviation{};  ///< the part of it that may last for a season: of the temperature [-]
  double common{};          ///< logarithm of common factors of the joints; 0: not known [-]
};

/// A line through the logarithms of a joint's friction over time, each weighted by its deviation. Where the factors
/// scatter more than their deviations say, their scatter counts. What is slow does not average out: it counts as if it
/// were of one sign in the first half and of the other in the second. A joint may answer to what the joints have in
/// common, their temperature, by more or less than the others: that is fitted beside the line.
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
  double halfWidth() const { return NORMAL_95 * deviation; }
};

/// Not known: fewer than MIN_RECORDINGS, or no time between them.
FrictionTrend frictionTrend(const std::vector<DatedFriction>& recordings);

/// Common factor of a group of joints in each recording: of the logarithms of their friction, each less the
/// joint's own median, the median joint's. It is taken alike of all recordings, so that it makes no step from one to
/// the other. `logarithms`: by joint and recording; none: not known. None: of fewer than MIN_WITNESSES joints.
std::vector<std::optional<double>> commonOfRecordings(
    const std::vector<std::vector<std::optional<double>>>& logarithms);
}  // namespace hjt
