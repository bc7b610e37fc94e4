// SPDX-License-Identifier: BSD-3-Clause
#include "health/friction_estimate.hpp"

#include <cmath>

namespace hjt
{
namespace
{
constexpr int COLUMNS = 5;
/// Speed and direction tell Coulomb from viscous friction only while their variance is inflated less than this [-]: two
/// speeds in the ratio 1 to 2, each way, give 10.
constexpr double MAX_INFLATION = 30.0;
}  // namespace

FrictionEstimate::FrictionEstimate(double memory) : memory_(memory), regression_(COLUMNS, 1) {}

void FrictionEstimate::reset() noexcept
{
  regression_.reset();
  fitted_ = false;
}

void FrictionEstimate::add(double travel, double velocity, double output_angle, double torque) noexcept
{
  regression_.forget(std::exp(-std::abs(travel) / memory_));
  Eigen::Matrix<double, COLUMNS, 1> row;
  row << std::copysign(1.0, velocity), velocity, std::cos(output_angle), std::sin(output_angle), 1.0;
  regression_.add(row, Eigen::Matrix<double, 1, 1>(torque));
}

void FrictionEstimate::fit() noexcept
{
  fitted_ = regression_.fit(COLUMNS);
}

Indicator FrictionEstimate::value(int column) const noexcept
{
  if (!fitted_ || regression_.inflation(0) > MAX_INFLATION || regression_.inflation(1) > MAX_INFLATION)
  {
    return {};
  }
  return { true, regression_.coefficient(column, 0) };
}
}  // namespace hjt
