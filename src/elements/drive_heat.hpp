// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Heat of the drive in two heat capacities: the grease with all moving parts of the drive, and the housing.
///
///   C_g dT_g/dt = P_f - G (T_g - T_h)
///   C_h dT_h/dt = P_m + P_0 + G (T_g - T_h) - G_a (T_h - T_a)
/// where T_g, T_h, T_a  temperatures of grease, housing and surroundings [degC]; C_g, C_h  heat capacities [J/K]
///       G, G_a  conductances [W/K]; P_f  friction, P_m  copper loss of the motor, P_0  standby power [W]
///
/// A step of any length is exact for constant powers and surroundings, because the two modes of the symmetric problem
/// in sqrt(C) T decay independently. If no heat flows out (G_a = 0), heat is conserved to rounding.
class DriveHeat
{
public:
  static constexpr double PERIOD = 0.1;  ///< time over which the twin averages the losses [s]

  explicit DriveHeat(const ThermalParameters& parameters)
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

  /// Sets both temperatures to `ambient` [degC], that of the surroundings, plus the rises in the configuration.
  void reset(double ambient) noexcept
  {
    grease_ = ambient + parameters_.grease_rise;
    housing_ = ambient + parameters_.housing_rise;
  }

  /// Losses in a step [J].
  struct Losses
  {
    double friction{};
    double copper{};
  };

  /// Advances both temperatures by `seconds` in surroundings of the temperature `ambient` [degC].
  void advance(double seconds, const Losses& losses, double ambient) noexcept
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

  /// Advances the temperature of the grease. `friction`: loss [J]; `housing`: measured housing temperature [degC].
  void advanceGrease(double seconds, double friction, double housing) noexcept
  {
    const double rate = parameters_.internal_conductance / parameters_.grease_capacity;
    grease_ = housing + std::exp(-rate * seconds) * (grease_ - housing) +
              meanDecay(rate, seconds) * friction / parameters_.grease_capacity;
    housing_ = housing;
  }

  double grease() const noexcept { return grease_; }    ///< temperature of the grease [degC]
  double housing() const noexcept { return housing_; }  ///< temperature of the housing [degC]

private:
  // Mean of exp(-rate t) over a step from t = 0 to `seconds` [-].
  static double meanDecay(double rate, double seconds) noexcept
  {
    const double decay = rate * seconds;
    return decay > 0.0 ? -std::expm1(-decay) / decay : 1.0;
  }

  ThermalParameters parameters_;
  Eigen::Vector2d root_;   // square roots of both heat capacities [sqrt(J/K)]
  Eigen::Vector2d rates_;  // decay rates of the modes [1/s]
  Eigen::Matrix2d modes_;  // modes as orthonormal columns
  double grease_{};
  double housing_{};
};
}  // namespace hjt
