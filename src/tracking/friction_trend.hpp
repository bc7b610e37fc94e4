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
  double time{};            ///< time of the recording, in any unit
  double factor{};          ///< friction over the expected one, apart from common factors of the joints, > 0 [-]
  double deviation{};       ///< standard deviation of its logarithm, > 0 [-]
  double slow_deviation{};  ///< part of `deviation` by the temperature, which may last for a season [-]
  double common{};          ///< logarithm of common factors of the joints; 0: not known [-]
};

/// A line through the logarithms of a joint's friction over time, each weighted by its deviation. Where the factors
/// scatter more than their deviations say, their scatter counts. Slow deviations do not average out: they count as if
/// they had one sign in the first half of the time and the other sign in the second half. A joint may respond to the
/// common temperature of the joints by more or less than the others do: the fit has a term for that response.
struct FrictionTrend
{
  static constexpr std::size_t MIN_RECORDINGS =
      4;  ///< two recordings determine a line, and the others have to confirm the line

  std::size_t recordings{};
  double span{};  ///< time from the first to the last recording
  double slope{
    std::numeric_limits<double>::quiet_NaN()
  };                   ///< slope of the logarithm, in 1 / unit of time; NaN: not known
  double deviation{};  ///< standard deviation of the slope

  bool isKnown() const { return std::isfinite(slope); }

  // 95 % intervals.
  double slopeLow() const { return slope - halfWidth(); }
  double slopeHigh() const { return slope + halfWidth(); }
  double change() const { return std::exp(slope * span); }  ///< friction at the end over that at the beginning [-]
  double changeLow() const { return std::exp(slopeLow() * span); }
  double changeHigh() const { return std::exp(slopeHigh() * span); }

  /// The whole interval of the change lies beyond MORE_THAN_OWN or LESS_THAN_OWN.
  bool departs() const { return changeLow() > 1.0 + MORE_THAN_OWN || changeHigh() < 1.0 - LESS_THAN_OWN; }

private:
  double halfWidth() const { return NORMAL_95 * deviation; }
};

/// The trend is not known with fewer than MIN_RECORDINGS recordings, or if all have the same time.
FrictionTrend frictionTrend(const std::vector<DatedFriction>& recordings);

/// Logarithm of the common factor of a group of joints in each recording: the median, over the joints, of the logarithm
/// of their friction less the joint's own median over the recordings. All recordings are treated alike, so that the
/// factor makes no step from one to the next. `logarithms`: by joint and recording; none: not known. The factor of a
/// recording is none if fewer than MIN_WITNESSES joints are known.
std::vector<std::optional<double>> commonOfRecordings(
    const std::vector<std::vector<std::optional<double>>>& logarithms);
}  // namespace hjt
