// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/current_lag.hpp"

#include <limits>

#include <Eigen/Cholesky>

namespace hjt
{
Eigen::Matrix2d LoadRegression::left() const
{
  constexpr double RIDGE =
      1e-9;  // share of the columns' squares that is added, because in one direction constant = friction [-]
  const Eigen::Matrix<double, OTHERS, OTHERS> others =
      sums_.topLeftCorner<OTHERS, OTHERS>() +
      Eigen::Matrix<double, OTHERS, OTHERS>(RIDGE * sums_.diagonal().head<OTHERS>().asDiagonal());
  const Eigen::Matrix<double, OTHERS, 2> both = sums_.topRightCorner<OTHERS, 2>();
  return sums_.bottomRightCorner<2, 2>() -
         both.transpose() * Eigen::Matrix<double, OTHERS, 2>(others.ldlt().solve(both));
}

double LoadRegression::leftByLoad() const
{
  const Eigen::Matrix2d rest = left();
  const double by_load = rest(0, 0) > 0.0 ? rest(0, 1) * rest(0, 1) / rest(0, 0) : 0.0;
  return seconds() < MIN_SECONDS ? std::numeric_limits<double>::quiet_NaN() :
                                   std::max(0.0, rest(1, 1) - by_load) / seconds();
}

FittedFactor LoadRegression::slopeOf(const Eigen::Matrix2d& left, double seconds)
{
  constexpr double CORRELATED = 0.5;   // time over which the errors of rows are alike [s]
  constexpr double MIN_CONTENT = 0.1;  // least rms of the unexplained load; errors of friction and inertia are less [A]
  FittedFactor slope;
  if (seconds < MIN_SECONDS || !(left(0, 0) > MIN_CONTENT * MIN_CONTENT * seconds))
  {
    return slope;
  }
  slope.value = left(0, 1) / left(0, 0);
  const double unexplained = std::max(0.0, left(1, 1) - slope.value * left(0, 1));
  slope.uncertainty = std::sqrt(unexplained / left(0, 0) * CORRELATED / seconds);
  return slope;
}

FittedFactor LoadRegression::slope(double& content) const
{
  const Eigen::Matrix2d rest = left();
  content = rest(0, 0);
  return slopeOf(rest, seconds());
}

namespace
{
constexpr double NOTEWORTHY = 0.06;  // least lag that counts; a shorter lag changes no verdict [s]
constexpr std::size_t MIDDLE = CurrentLag::LAGS / 2;
}  // namespace

double ownLag(const std::array<double, CurrentLag::LAGS>& left)
{
  constexpr double CLEARLY = 0.75;  // largest rms of the residual with the lag, over the rms without a lag [-]
  std::size_t best = MIDDLE;
  for (std::size_t i = 1; i + 1 < CurrentLag::LAGS; ++i)
  {
    best = left[i] < left[best] ? i : best;
  }
  const double lag = CurrentLag::lagAt(best);
  constexpr double LONG = 0.1;  // least lag that counts; a shorter lag has the effect of friction at low speed [s]
  return std::abs(lag) > LONG && std::sqrt(left[best] / left[MIDDLE]) < CLEARLY ? lag : 0.0;
}

double commonLag(const std::vector<std::array<double, CurrentLag::LAGS>>& left)
{
  constexpr double CLEARLY =
      0.93;  // largest rms of the residual with the lag, over the rms without a lag; a sound UR5 has more [-]
  constexpr double AGREES = 0.96;  // largest ratio of these rms in a joint that agrees with the lag [-]
  double best_share = CLEARLY;
  double best_lag = 0.0;
  for (std::size_t i = 0; i < CurrentLag::LAGS; ++i)
  {
    double logarithms = 0.0;
    std::size_t known = 0;
    std::size_t agree = 0;
    for (const auto& joint : left)
    {
      if (joint[i] > 0.0 && joint[MIDDLE] > 0.0)
      {
        const double share = std::sqrt(joint[i] / joint[MIDDLE]);
        logarithms += std::log(share);
        ++known;
        agree += share < AGREES ? 1 : 0;
      }
    }
    const double share = known > 0 ? std::exp(logarithms / static_cast<double>(known)) : 1.0;
    if (known > 1 && 2 * agree > known && share < best_share)
    {
      best_share = share;
      best_lag = CurrentLag::lagAt(i);
    }
  }
  return std::abs(best_lag) > NOTEWORTHY ? best_lag : 0.0;
}
}  // namespace hjt
