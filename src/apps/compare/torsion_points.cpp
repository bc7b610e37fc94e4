// SPDX-License-Identifier: BSD-3-Clause
#include "apps/compare/torsion_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hjt
{
TorsionPoints::TorsionPoints(const Parameters& parameters)
  : step_(std::max(parameters.output.load_torque_limit, 1.0) / STEPS), curve_(parameters), regression_(3, 1)
{
}

void TorsionPoints::add(double torque, double torsion, double position, double speed)
{
  const double twin = curve_.torsion(torque);
  const double way = speed < 0.0 ? -1.0 : 1.0;
  regression_.add(Eigen::Vector3d(1.0, way, twin), Eigen::Matrix<double, 1, 1>(torsion));
  ++rows_;
  twin_sum_ += twin;
  twin_squares_ += twin * twin;
  const Eigen::Vector2d turn(std::cos(position), std::sin(position));
  turn_sum_ += turn;
  turn_squares_ += turn * turn.transpose();
  Bin& bin = bins_[speed < 0.0 ? 1 : 0][static_cast<int>(std::lround(torque / step_))];
  bin.sum += torsion;
  bin.rows += 1.0;
}

double TorsionPoints::twinAmplitude() const
{
  const auto n = static_cast<double>(rows_);
  return rows_ == 0 ? 0.0 : std::sqrt(std::max(0.0, twin_squares_ / n - std::pow(twin_sum_ / n, 2)));
}

double TorsionPoints::turnAmplitude() const
{
  const double n = std::max(static_cast<double>(rows_), 1.0);
  const Eigen::Matrix2d squares = turn_squares_ / n - turn_sum_ * turn_sum_.transpose() / (n * n);
  // The root of the larger eigenvalue.
  return std::sqrt(0.5 * squares.trace() + std::hypot(0.5 * (squares(0, 0) - squares(1, 1)), squares(0, 1)));
}

RunningRegression TorsionPoints::fitted() const
{
  RunningRegression regression = regression_;
  regression.fit(3);
  return regression;
}

double TorsionPoints::compliance() const
{
  return twinAmplitude() < MIN_VARIED ? std::numeric_limits<double>::quiet_NaN() : fitted().coefficient(2, 0);
}

std::vector<TorsionMean> TorsionPoints::means() const
{
  std::vector<TorsionMean> means;
  if (rows_ == 0)
  {
    return means;
  }
  const double zero = fitted().coefficient(0, 0);
  std::map<int, TorsionMean> by_torque;
  for (const int way : { 0, 1 })
  {
    for (const auto& [step, bin] : bins_[way])
    {
      TorsionMean& mean =
          by_torque.try_emplace(step, TorsionMean{ step * step_, std::nan(""), std::nan("") }).first->second;
      (way == 0 ? mean.forward : mean.backward) = bin.sum / bin.rows - zero;
    }
  }
  for (const auto& [step, mean] : by_torque)
  {
    means.push_back(mean);
  }
  return means;
}
}  // namespace hjt
