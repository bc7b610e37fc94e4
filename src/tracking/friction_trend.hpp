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
/// Friction of a joint in one recording of several.
struct DatedFriction
{
  double time{};            ///< time of the recording, in any unit
  double factor{};          ///< measured over expected friction, apart from common factors of the joints, > 0 [-]
  double deviation{};       ///< standard deviation of the factor's logarithm, > 0 [-]
  double slow_deviation{};  ///< part of `deviation` by an unknown temperature, which may last for a season [-]
  double common{};          ///< logarithm of the joints' common factor; 0: not known [-]
};

/// A line through the logarithms of a joint's friction factors over time, weighted by the deviations of the factors. If
/// the factors scatter more than their deviations say, the larger scatter counts. Slow deviations do not average out:
/// the worst case counts, in which they act on the slope with the same sign in all recordings. A joint may respond to
/// the common temperature more or less than the other joints, so the fit has a term for this response.
struct FrictionTrend
{
  static constexpr std::size_t MIN_RECORDINGS = 4;  ///< two recordings determine a line, and two more confirm it

  std::size_t recordings{};
  double span{};  ///< time from the first to the last recording, in the unit of the times
  double slope{
    std::numeric_limits<double>::quiet_NaN()
  };                   ///< slope of the logarithm per unit of time; NaN: not known
  double deviation{};  ///< standard deviation of the slope, in 1 / unit of time

  bool isKnown() const { return std::isfinite(slope); }

  // Functions whose names end with Low and High give the ends of the 95 % intervals of slope and change.
  double slopeLow() const { return slope - halfWidth(); }
  double slopeHigh() const { return slope + halfWidth(); }
  double change() const { return std::exp(slope * span); }  ///< friction at the end over friction at the beginning [-]
  double changeLow() const { return std::exp(slopeLow() * span); }
  double changeHigh() const { return std::exp(slopeHigh() * span); }

  /// Whether the whole interval of change() lies above 1 + MORE_THAN_OWN or below 1 - LESS_THAN_OWN.
  bool departs() const { return changeLow() > 1.0 + MORE_THAN_OWN || changeHigh() < 1.0 - LESS_THAN_OWN; }

private:
  double halfWidth() const { return NORMAL_95 * deviation; }
};

/// Fits the trend. Its slope is not known with fewer than MIN_RECORDINGS recordings, or if all have the same time.
FrictionTrend frictionTrend(const std::vector<DatedFriction>& recordings);

/// Logarithm of the common friction factor of a group of joints in each recording. The function subtracts from the
/// logarithm of each joint's friction the joint's median over the recordings, and takes the median of these differences
/// over the joints. `logarithms`: logarithm of the friction for each joint and recording; none: not known. The result
/// for a recording is none if the friction of fewer than MIN_WITNESSES joints is known there.
std::vector<std::optional<double>> commonOfRecordings(
    const std::vector<std::vector<std::optional<double>>>& logarithms);
}  // namespace hjt
