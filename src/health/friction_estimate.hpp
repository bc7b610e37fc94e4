// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "harmonic_joint_twin/health/indicator.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// Coulomb and viscous friction at the motor shaft.
///
/// Law:   tau - T / i = C sign(omega) + B omega + g_c cos(phi) + g_s sin(phi) + g_0
/// where  tau, T      motor torque, load estimate (0 if none) [N.m];  i  ratio [-]
///        omega, phi  motor speed over about a turn [rad/s], output angle [rad]; the terms in phi take up the weight
/// Recursive least squares over samples at near-constant speed, forgotten exponentially over travel.
/// Valid while the motion separates the two: several speeds, each way.
class FrictionEstimate
{
public:
  /// `memory`: travel of the motor after which a sample counts 1/e [rad].
  explicit FrictionEstimate(double memory) : memory_(memory), regression_(COLUMNS, 1) {}

  void reset() noexcept
  {
    regression_.reset();
    fitted_ = false;
  }

  /// `travel`: of the motor since the last sample [rad].
  void add(double travel, double velocity, double output_angle, double torque) noexcept
  {
    regression_.forget(std::exp(-std::abs(travel) / memory_));
    Eigen::Matrix<double, COLUMNS, 1> row;
    row << std::copysign(1.0, velocity), velocity, std::cos(output_angle), std::sin(output_angle), 1.0;
    regression_.add(row, Eigen::Matrix<double, 1, 1>(torque));
  }

  void fit() noexcept { fitted_ = regression_.fit(COLUMNS); }

  Indicator coulomb() const noexcept { return value(0); }  ///< [N.m]
  Indicator viscous() const noexcept { return value(1); }  ///< [N.m.s/rad]

private:
  static constexpr int COLUMNS = 5;
  /// Speed and direction tell Coulomb from viscous friction only while their variance is inflated less than this [-]:
  /// two speeds in the ratio 1 to 2, each way, give 10.
  static constexpr double MAX_INFLATION = 30.0;

  Indicator value(int column) const noexcept
  {
    if (!fitted_ || regression_.inflation(0) > MAX_INFLATION || regression_.inflation(1) > MAX_INFLATION)
    {
      return {};
    }
    return { true, regression_.coefficient(column, 0) };
  }

  double memory_;
  bool fitted_{};
  RunningRegression regression_;
};
}  // namespace hjt
