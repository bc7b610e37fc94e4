// SPDX-License-Identifier: BSD-3-Clause
#include "apps/compare/torsion_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"

namespace hjt
{
TorsionPoints::TorsionPoints(const Parameters& parameters) : regression_(3, 1)
{
  const std::vector<double> torques{ 0.0, 5.0, 14.0, 25.0, 48.0, 75.0, 110.0, 150.0, 200.0, LARGEST };
  for (const StiffnessRow& row : analyseStiffness(parameters, 0.0, torques))
  {
    if (!row.status.ok())
    {
      throw ParameterError("the ring finds no equilibrium under a load of " + numberText(row.torque) +
                           " N.m at the output: " + explanationOf(row.status));
    }
    curve_.push_back({ row.torque, -row.output_angle });
  }
}

double TorsionPoints::twinTorsion(double torque) const
{
  const double size = std::abs(torque);
  const auto above = std::find_if(curve_.begin() + 1, curve_.end() - 1,
                                  [size](const CurvePoint& point) { return point.torque >= size; });
  const CurvePoint& low = *(above - 1);
  const double slope = (above->torsion - low.torsion) / (above->torque - low.torque);
  return std::copysign(low.torsion + slope * (size - low.torque), torque);
}

void TorsionPoints::add(double torque, double torsion, double speed)
{
  const double twin = twinTorsion(torque);
  const double way = speed < 0.0 ? -1.0 : 1.0;
  regression_.add(Eigen::Vector3d(1.0, way, twin), Eigen::Matrix<double, 1, 1>(torsion));
  ++rows_;
  twin_sum_ += twin;
  twin_squares_ += twin * twin;
  Bin& bin = bins_[speed < 0.0 ? 1 : 0][static_cast<int>(std::lround(torque / STEP))];
  bin.sum += torsion;
  bin.rows += 1.0;
}

double TorsionPoints::twinAmplitude() const
{
  const auto n = static_cast<double>(rows_);
  return rows_ == 0 ? 0.0 : std::sqrt(std::max(0.0, twin_squares_ / n - std::pow(twin_sum_ / n, 2)));
}

RunningRegression TorsionPoints::fitted() const
{
  RunningRegression regression = regression_;
  regression.fit(3);
  return regression;
}

double TorsionPoints::compliance() const
{
  return twinAmplitude() < LEAST_VARIED ? std::numeric_limits<double>::quiet_NaN() : fitted().coefficient(2, 0);
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
          by_torque.try_emplace(step, TorsionMean{ step * STEP, std::nan(""), std::nan("") }).first->second;
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
