// SPDX-License-Identifier: BSD-3-Clause
#include "elements/drive_heat.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace hjt
{
namespace
{
/// Mean of exp(-rate t) over a step from 0 on [-].
double meanDecay(double rate, double seconds) noexcept
{
  const double decay = rate * seconds;
  return decay > 0.0 ? -std::expm1(-decay) / decay : 1.0;
}
}  // namespace

DriveHeat::DriveHeat(const ThermalParameters& parameters)
  : parameters_(parameters), root_(std::sqrt(parameters.grease_capacity), std::sqrt(parameters.housing_capacity))
{
  const double inner = parameters.internal_conductance;
  const double between = -inner / (root_[0] * root_[1]);
  Eigen::Matrix2d relaxation;
  relaxation << inner / parameters.grease_capacity, between, between,
      (inner + parameters.ambient_conductance) / parameters.housing_capacity;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(relaxation);
  rates_ = solver.eigenvalues().cwiseMax(0.0);
  modes_ = solver.eigenvectors();
}

void DriveHeat::reset(double ambient) noexcept
{
  grease_ = ambient + parameters_.grease_rise;
  housing_ = ambient + parameters_.housing_rise;
}

void DriveHeat::advance(double seconds, const Losses& losses, double ambient) noexcept
{
  const Eigen::Vector2d above(grease_ - ambient, housing_ - ambient);
  const Eigen::Vector2d energy(losses.friction, losses.copper + parameters_.standby_power * seconds);
  const Eigen::Vector2d start = modes_.transpose() * root_.cwiseProduct(above);
  const Eigen::Vector2d fed = modes_.transpose() * energy.cwiseQuotient(root_);
  Eigen::Vector2d end;
  for (int i = 0; i < 2; ++i)
  {
    end[i] = std::exp(-rates_[i] * seconds) * start[i] + meanDecay(rates_[i], seconds) * fed[i];
  }
  const Eigen::Vector2d temperature = (modes_ * end).cwiseQuotient(root_);
  grease_ = ambient + temperature[0];
  housing_ = ambient + temperature[1];
}

void DriveHeat::advanceGrease(double seconds, double friction, double housing) noexcept
{
  const double rate = parameters_.internal_conductance / parameters_.grease_capacity;
  grease_ = housing + std::exp(-rate * seconds) * (grease_ - housing) +
            meanDecay(rate, seconds) * friction / parameters_.grease_capacity;
  housing_ = housing;
}
}  // namespace hjt
