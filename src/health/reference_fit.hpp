// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
constexpr double LEAST_LEFT = 1e-4;  ///< of a variance by the common causes: they are known no better

using Squares = Eigen::Matrix<double, PLACES, PLACES, Eigen::RowMajor>;
using PlaceVector = Eigen::Matrix<double, PLACES, 1>;

inline Eigen::Map<const Squares> mapped(const PlaceSquares& squares) noexcept
{
  return Eigen::Map<const Squares>(squares.front().data());
}
inline Eigen::Map<Squares> mapped(PlaceSquares& squares) noexcept
{
  return Eigen::Map<Squares>(squares.front().data());
}
inline Eigen::Map<const PlaceVector> mapped(const Place& place) noexcept
{
  return Eigen::Map<const PlaceVector>(place.data());
}
inline Eigen::Map<PlaceVector> mapped(Place& place) noexcept
{
  return Eigen::Map<PlaceVector>(place.data());
}

/// Standard error of each line over the least one of its signal's lines in the same window: what the motion makes of
/// it, whatever the noise [-]. 0: not known.
std::array<double, INDICATOR_COUNT> relativeErrors(const SignalIndicators& indicators) noexcept;

/// Takes a window up into the sums of its class; `here`: its place there. Does not allocate.
void learnWindow(ReferenceBin& bin, LearnedSums& sums, const SignalIndicators& indicators, const Place& here) noexcept;

/// Makes of the sums what windows are compared with: the straight line over the place by least squares, and of what it
/// leaves the first principal components of the correlations, as many as stand out of noise, COMMON_CAUSES at most:
/// eigenvalue above the edge (1 + sqrt(p / n))^2 of p independent indicators in n windows (Marchenko and Pastur 1967).
/// Slopes over load and payload are those of all of `bins` that differ from this one, one of them, in temperature at
/// most: a class sees few payloads. Slopes of indicators that 16 windows determined, components of those that every
/// window did. `all_sums`: by `bins`. Does not allocate.
void fitReference(ReferenceBin& bin, const LearnedSums& sums, const std::vector<ReferenceBin>& bins,
                  const std::vector<LearnedSums>& all_sums, FitRoom& room) noexcept;
}  // namespace hjt
