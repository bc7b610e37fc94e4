// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Friction of the wave generator's ball bearing after Palmgren (thesis eq. 7.31-7.33; both parts oppose the speed).
///
///   T0 = f0 (nu n)^(2/3) d_m^3 1e-7   for nu n >= 2000,   f0 160 d_m^3 1e-7  below   [N.mm]
///   T1 = f1 (F + F_race) d_m                                                         [N.mm]
/// where nu  viscosity of the base oil after Ubbelohde and Walther (DIN 51563) [mm^2/s],
///           lg lg(nu + 0.7) = lg lg(nu_0 + 0.7) - m lg(T / T_0), T in kelvin
///       n   in rpm, d_m in mm
///       F   sum of the contact forces between wave generator and flexspline [N]
///       F_race  ball forces of the bearing's own outer race, bent to the ellipse [N]
class BearingFriction
{
public:
  explicit BearingFriction(const BearingParameters& parameters)
    : parameters_(parameters), preload_(parameters.race_preload)
  {
  }

  /// Grease of another viscosity, by this factor at any temperature [-].
  void scaleViscosity(double factor) noexcept { viscosity_factor_ *= factor; }
  /// Reduces the preload of the race by `loss`, not below min(`least`, present preload) [N].
  void reducePreload(double loss, double least) noexcept;

  /// Size of the friction torque, >= 0 [N.m], at motor speed [rad/s], load [N] and temperature [degC].
  double torque(double speed, double load, double temperature) const noexcept
  {
    return torqueAtViscosity(speed, load, viscosity(temperature));
  }

  /// The same where the viscosity [m^2/s] is known: it is the costly part, and the temperature hardly changes.
  double torqueAtViscosity(double speed, double load, double viscosity) const noexcept;

  /// Kinematic viscosity of the base oil [m^2/s] at a temperature [degC].
  double viscosity(double temperature) const noexcept;

private:
  BearingParameters parameters_;
  double preload_;  // [N]
  double viscosity_factor_{ 1.0 };
};
}  // namespace hjt
