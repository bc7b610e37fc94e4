// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Load of the output: inertia, friction and gravity (thesis eq. 7.37-7.38 with corrected brackets).
///
/// Energy of gravity [J]:  -m g l cos(phi - phi_g), phi output angle, phi_g angle at which the load hangs straight down
class Load
{
public:
  explicit Load(const OutputParameters& parameters) : parameters_(parameters) {}

  double inertia() const noexcept { return parameters_.circular_spline_inertia + parameters_.load_inertia; }
  double viscousFriction() const noexcept { return parameters_.viscous_friction; }
  /// Dry friction of the output's bearing and seals, including the part that the tilting moment causes [N.m].
  double dryFriction() const noexcept
  {
    return parameters_.coulomb_torque + parameters_.tilting_friction * parameters_.tilting_moment;
  }

  double gravityEnergy(double angle) const noexcept
  {
    return weightless() ? 0.0 : -parameters_.gravity_torque * std::cos(angle - parameters_.gravity_angle);
  }
  /// Torque of gravity on the output: minus the derivative of gravity's energy by the output angle [N.m].
  double gravityTorque(double angle) const noexcept
  {
    return weightless() ? 0.0 : -parameters_.gravity_torque * std::sin(angle - parameters_.gravity_angle);
  }
  /// Second derivative of gravity's energy by the output angle [N.m/rad].
  double gravityStiffness(double angle) const noexcept
  {
    return parameters_.gravity_torque * std::cos(angle - parameters_.gravity_angle);
  }

private:
  bool weightless() const noexcept { return parameters_.gravity_torque == 0.0; }

  OutputParameters parameters_;
};
}  // namespace hjt
