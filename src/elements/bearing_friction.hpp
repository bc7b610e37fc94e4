// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Friction of the wave generator's ball bearing after Palmgren (thesis eq. 7.31-7.33; both parts oppose the speed).
///
///   T0 = f0 (nu n)^(2/3) d_m^3 1e-7   for nu n >= 2000,   f0 160 d_m^3 1e-7  below   [N.mm]
///   T1 = f1 (F + F_race) d_m                                                         [N.mm]
/// where nu  viscosity that the friction by speed acts with [mm^2/s]: nu^(2/3) = nu(T_0)^(2/3) (c + (1 - c) r^(2/3)),
///           c the share that no temperature changes, of what is no grease, and r = nu_oil(T) / nu_oil(T_0);
///           the oil's after Walther (ASTM D341), T in kelvin:
///           lg lg(nu_oil + 0.7) = lg lg(nu_oil(T_0) + 0.7) - m lg(T / T_0)
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
  void reducePreload(double loss, double least) noexcept
  {
    preload_ = std::max(preload_ - loss, std::min(least, preload_));
  }

  /// Size of the friction torque, >= 0 [N.m], at motor speed [rad/s], load [N] and temperature [degC].
  double torque(double speed, double load, double temperature) const noexcept
  {
    return torqueAtViscosity(speed, load, viscosity(temperature));
  }

  /// The same where the viscosity [m^2/s] is known: it is the costly part, and the temperature hardly changes.
  double torqueAtViscosity(double speed, double load, double viscosity) const noexcept
  {
    constexpr double LOW_SPEED = 2000.0;  // mm^2/s rpm
    const double product = 1e6 * viscosity * std::abs(speed) * 60.0 / TWO_PI;
    const double diameter = 1e3 * parameters_.pitch_diameter;
    const double rolling = product < LOW_SPEED ? 160.0 : twoThirdsPower(product);
    const double speed_part = parameters_.lubricant_factor * rolling * diameter * diameter * diameter * 1e-7;
    const double load_part = parameters_.load_factor * (load + preload_) * diameter;
    return 1e-3 * (speed_part + load_part);
  }

  /// Kinematic viscosity that the friction by speed acts with [m^2/s] at a temperature [degC].
  double viscosity(double temperature) const noexcept
  {
    constexpr double ZERO_CELSIUS = 273.15;  // K
    constexpr double OFFSET = 0.7;           // mm^2/s; DIN 51563 has 0.8
    const double known = std::log10(1e6 * parameters_.oil_viscosity + OFFSET);
    const double ratio = (temperature + ZERO_CELSIUS) / (parameters_.viscosity_temperature + ZERO_CELSIUS);
    const double oil = 1e-6 * (std::pow(10.0, known * std::pow(ratio, -parameters_.viscosity_slope)) - OFFSET);
    const double grease = viscosity_factor_ * parameters_.viscosity / parameters_.oil_viscosity * oil;
    const double constant = parameters_.constant_share;
    if (constant == 0.0)
    {
      return grease;
    }
    const double root = std::cbrt(grease / parameters_.viscosity);
    const double friction = constant + (1.0 - constant) * root * root;  // over that of the sound grease at T_0
    return parameters_.viscosity * friction * std::sqrt(friction);
  }

  /// x^(2/3), x > 0 and finite, within 1e-14 of it: x times its reciprocal cube root, which begins with a third of the
  /// exponent, 4 % off, and by the series of (1 - e)^(-1/3) comes to 2e-6 and to rounding.
  static double twoThirdsPower(double x) noexcept
  {
    constexpr std::uint64_t ONE = 0x553ef0ff289dd796;  // offset with which a third of the bits of 1 are those of 1
    std::uint64_t bits{};
    std::memcpy(&bits, &x, sizeof(bits));
    bits = ONE - bits / 3;
    double root{};
    std::memcpy(&root, &bits, sizeof(root));
    for (int i = 0; i < 2; ++i)
    {
      const double e = 1.0 - x * root * root * root;
      root += root * e * (1.0 / 3.0 + e * (2.0 / 9.0 + e * (14.0 / 81.0 + e * (35.0 / 243.0))));
    }
    return x * root;
  }

private:
  BearingParameters parameters_;
  double preload_;  // [N]
  double viscosity_factor_{ 1.0 };
};
}  // namespace hjt
