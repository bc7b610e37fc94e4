// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Cholesky>

#include "arm/recording_fit.hpp"

namespace hjt
{
namespace
{
constexpr double RIDGE = 1e-9;  // of the mean square: motion one way only leaves constant and friction alike
}  // namespace

void RecordingFit::LoadRegression::add(double step, double velocity, double acceleration, double load,
                                       double current) noexcept
{
  constexpr double MEMORY = 120.0;  // of motion [s]
  Eigen::Matrix<double, TERMS, 1> row;
  row << 1.0, velocity > 0.0 ? 1.0 : -1.0, velocity, acceleration, load, current;
  sums_ = (1.0 - step / MEMORY) * sums_ + step * row * row.transpose();
}

Eigen::Matrix2d RecordingFit::LoadRegression::left() const
{
  const Eigen::Matrix<double, OTHERS, OTHERS> others =
      sums_.topLeftCorner<OTHERS, OTHERS>() +
      Eigen::Matrix<double, OTHERS, OTHERS>(RIDGE * sums_.diagonal().head<OTHERS>().asDiagonal());
  const Eigen::Matrix<double, OTHERS, 2> both = sums_.topRightCorner<OTHERS, 2>();
  return sums_.bottomRightCorner<2, 2>() -
         both.transpose() * Eigen::Matrix<double, OTHERS, 2>(others.ldlt().solve(both));
}

FittedFactor RecordingFit::LoadRegression::slope(double& content) const
{
  constexpr double CORRELATED = 0.5;  // rows nearer to each other tell the same [s]
  constexpr double MIN_SECONDS = 3.0;
  constexpr double MIN_CONTENT = 0.1;  // of the load that is left, rms: errors of friction and inertia leave less [A]
  const double seconds = sums_(0, 0);
  FittedFactor slope;
  if (seconds < MIN_SECONDS)
  {
    return slope;
  }
  const Eigen::Matrix2d rest = left();
  if (rest(0, 0) <= MIN_CONTENT * MIN_CONTENT * seconds)
  {
    return slope;
  }
  content = rest(0, 0);
  slope.value = rest(0, 1) / rest(0, 0);
  const double unexplained = std::max(0.0, rest(1, 1) - slope.value * rest(0, 1));
  slope.uncertainty = std::sqrt(unexplained / rest(0, 0) * CORRELATED / seconds);
  return slope;
}
}  // namespace hjt
