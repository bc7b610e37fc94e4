// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

// Rules between the parameters of a gear: docs/gear_study.md derives it.
namespace hjt
{
/// w0 at which the teeth roll in their spaces without jamming [m]: a tooth at mid-height z above the bore moves by
/// w0 (1/2 - 3 z / (2 r0)) along the circumference, and the pitch of the spaces asks for (r0 + z) / (N + 2).
inline double fittingWaveAmplitude(const GearParameters& gear) noexcept
{
  const double radius = gear.flexspline_inner_radius;
  const double height = gear.rim_thickness + 0.5 * gear.tooth_height_flexspline;
  return (radius + height) / ((gear.teeth_flexspline + 2) * (0.5 - 1.5 * height / radius));
}

/// Tip radius of the circular spline at which the teeth engage to the depth w0 [m].
inline double fittingTipRadius(const GearParameters& gear) noexcept
{
  return gear.flexspline_inner_radius + gear.rim_thickness + gear.tooth_height_flexspline;
}

/// Length of a segment of the rim [m].
inline double segmentLength(const GearParameters& gear) noexcept
{
  return 2.0 * gear.flexspline_inner_radius * std::sin(PI / gear.teeth_flexspline);
}

/// E b t / p, of the rim between two teeth, which bear nothing [N/m].
inline double rimTensionStiffness(const Parameters& parameters) noexcept
{
  const GearParameters& gear = parameters.gear;
  return parameters.life.elastic_modulus * parameters.life.face_width * gear.rim_thickness / segmentLength(gear);
}

/// E b t^3 / (12 p (1 - c)), of rigid teeth with the rim bending between them: the stiffest that it can be [N.m/rad].
inline double rimBendingStiffness(const Parameters& parameters) noexcept
{
  const GearParameters& gear = parameters.gear;
  return parameters.life.elastic_modulus * parameters.life.face_width * std::pow(gear.rim_thickness, 3) /
         (12.0 * segmentLength(gear) * (1.0 - parameters.stress.tooth_base));
}
}  // namespace hjt
