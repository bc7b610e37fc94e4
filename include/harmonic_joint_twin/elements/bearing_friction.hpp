// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Friction of the wave generator's ball bearing after Palmgren (thesis eq. 7.31-7.33; both parts oppose the speed).
///
///   T0 = f0 (nu n)^(2/3) d_m^3 1e-7   for nu n >= 2000,   f0 160 d_m^3 1e-7  below   [N.mm]
///   T1 = f1 F d_m                                                                    [N.mm]
/// where nu in mm^2/s falls exponentially with temperature, n in rpm, d_m in mm, F the sum of the contact forces [N].
class BearingFriction
{
public:
  explicit BearingFriction(const BearingParameters& parameters) : parameters_(parameters) {}

  /// Size of the friction torque, >= 0 [N.m], at motor speed [rad/s], load [N] and temperature [degC].
  double torque(double speed, double load, double temperature) const noexcept;

private:
  BearingParameters parameters_;
};
}  // namespace hjt
