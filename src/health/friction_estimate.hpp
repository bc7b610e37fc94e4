// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
  explicit FrictionEstimate(double memory);

  void reset() noexcept;
  /// `travel`: of the motor since the last sample [rad].
  void add(double travel, double velocity, double output_angle, double torque) noexcept;
  void fit() noexcept;

  Indicator coulomb() const noexcept { return value(0); }  ///< [N.m]
  Indicator viscous() const noexcept { return value(1); }  ///< [N.m.s/rad]

private:
  Indicator value(int column) const noexcept;

  double memory_;
  bool fitted_{};
  RunningRegression regression_;
};
}  // namespace hjt
