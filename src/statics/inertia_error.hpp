// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Expected error of a ring model without inertia at a motor speed [rad/s] and a torque at the output [N.m]: rms error
/// of the flank forces over the loaded teeth [N].
///
///   E = a m w^2 r0 sqrt(1 + (T / (p r0^3))^4)
/// where  m, r0  mass [kg] and inner radius [m] of the toothed rim;  w  motor speed [rad/s];  T  torque [N.m]
///        a, p   fitted to the dynamic ring of the shipped gear, 20 and 100 N.m, up to 317 rad/s (docs/model.md)
///
/// At speeds at which the engagement of the teeth excites a mode of the ring, the error is several times larger than E.
/// At most other speeds the error is smaller than E.
inline double expectedMeshForceError(const RingParameters& ring, const GearParameters& gear, double motor_speed,
                                     double torque) noexcept
{
  constexpr double SHARE = 5.5e-3;     // a [-]
  constexpr double PRESSURE = 1.43e6;  // p [Pa]
  const double radius = gear.flexspline_inner_radius;
  const double relative = torque / (PRESSURE * radius * radius * radius);
  const double square = relative * relative;
  return SHARE * ring.mass * motor_speed * motor_speed * radius * std::sqrt(1.0 + square * square);
}
}  // namespace hjt
