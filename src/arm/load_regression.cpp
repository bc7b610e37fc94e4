// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "arm/recording_fit.hpp"
#include "params/choices.hpp"

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
  constexpr double MIN_CONTENT = 0.1;  // least rms of the remaining load: errors of friction and inertia leave less [A]
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

EffortFit RecordingFit::effort() const
{
  constexpr double WIDE = 2.0;                   // a payload or another gain make no more of it
  constexpr double MAX_UNCERTAINTY = 1.0 / 3.0;  // share of the factor: beyond, the effort may not contain the load
  EffortFit fit;
  fit.unit = joints_.front().effort;
  double weights = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  const auto units = choiceNames(EffortUnit());
  std::vector<double> expected(units.size());
  for (const Joint& joint : joints_)
  {
    // By the load, not by the uncertainty: a dead current would be the most certain one.
    double weight = 0.0;
    const FittedFactor slope = joint.load.slope(weight);
    if (!std::isfinite(slope.value) || joint.reach.least_current == joint.reach.most_current)
    {
      continue;
    }
    weights += weight;
    sum += weight * slope.value;
    squares += weight * weight * slope.uncertainty * slope.uncertainty;
    for (std::size_t unit = 0; unit < units.size(); ++unit)
    {
      // If the effort is of this unit, its current is too large by as much as the configured unit's factor.
      expected[unit] +=
          weight * joint.current_per_effort[static_cast<std::size_t>(joint.effort)] / joint.current_per_effort[unit];
    }
  }
  if (weights == 0.0 || std::sqrt(squares) > MAX_UNCERTAINTY * sum)
  {
    return fit;
  }
  fit.factor = { sum / weights, std::sqrt(squares) / weights };
  const auto distance = [&](EffortUnit unit)
  { return std::abs(std::log(fit.factor.value * weights / expected[static_cast<std::size_t>(unit)])); };
  fit.is_known = distance(fit.unit) < std::log(WIDE);
  for (const auto& [name, unit] : units)
  {
    if (!fit.is_known && distance(unit) < std::log(WIDE) && distance(unit) < distance(fit.unit) - std::log(WIDE))
    {
      fit.unit = unit;
      fit.is_known = true;
    }
  }
  return fit;
}

RecordingFit::LoadRest RecordingFit::loadRest(EffortUnit unit) const
{
  LoadRest sum;
  double seconds = 0.0;
  for (const Joint& joint : joints_)
  {
    const double scale = joint.current_per_effort[static_cast<std::size_t>(unit)] /
                         joint.current_per_effort[static_cast<std::size_t>(joint.effort)];
    const Eigen::Matrix2d left = joint.load.left();
    sum.current += scale * scale * left(1, 1);
    sum.left += std::max(0.0, scale * scale * left(1, 1) - 2.0 * scale * left(0, 1) + left(0, 0));
    seconds += joint.load.seconds();
  }
  return { std::sqrt(sum.current / seconds), std::sqrt(sum.left / seconds) };
}
}  // namespace hjt
