// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Rules for the parameters of a gear; docs/gear_study.md derives them.

#include <cmath>
#include <string>
#include <vector>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Amplitude w0 at which the teeth roll in their spaces without jamming [m]. At the mid-height z of the teeth above the
/// bore of radius r0, a tooth moves by w0 (1/2 - 3 z / (2 r0)) along the circumference. The pitch of N + 2 spaces
/// requires a movement of (r0 + z) / (N + 2).
inline double fittingWaveAmplitude(const GearParameters& gear) noexcept
{
  const double radius = gear.flexspline_inner_radius;
  const double height = gear.rim_thickness + 0.5 * gear.tooth_height_flexspline;
  return (radius + height) / ((gear.teeth_flexspline + 2) * (0.5 - 1.5 * height / radius));
}

/// Tip radius of the circular spline at which the teeth engage to the depth of the wave amplitude [m].
inline double fittingTipRadius(const GearParameters& gear) noexcept
{
  return gear.flexspline_inner_radius + gear.rim_thickness + gear.tooth_height_flexspline;
}

/// Length of a segment of the rim [m].
inline double segmentLength(const GearParameters& gear) noexcept
{
  return 2.0 * gear.flexspline_inner_radius * std::sin(PI / gear.teeth_flexspline);
}

/// Tension stiffness of the rim between two teeth, without the stiffness of the teeth themselves [N/m].
inline double rimTensionStiffness(const Parameters& parameters) noexcept
{
  const GearParameters& gear = parameters.gear;
  return parameters.life.elastic_modulus * parameters.life.face_width * gear.rim_thickness / segmentLength(gear);
}

/// Upper bound of the rim's bending stiffness between two teeth: its value if the teeth are rigid [N.m/rad].
inline double rimBendingStiffness(const Parameters& parameters) noexcept
{
  const GearParameters& gear = parameters.gear;
  return parameters.life.elastic_modulus * parameters.life.face_width * std::pow(gear.rim_thickness, 3) /
         (12.0 * segmentLength(gear) * (1.0 - parameters.stress.tooth_base));
}

/// Part of the joint that an analysis contains.
enum class Analysis
{
  INSERTION,     ///< ring on the wave generator, without circular spline and friction
  RING,          ///< the whole ring without friction
  WITH_FRICTION  ///< the whole joint
};

/// Checks that all faults can act in an analysis. An analysis has no time, so every onset must be 0.
/// @throws ParameterError for a configured fault that cannot act.
void requireFaultsAct(const Parameters& parameters, Analysis analysis);

/// Message that the teeth of the sound gear jam without load, so that the gear cannot turn; empty if they do not jam.
std::string jamOf(const Parameters& parameters);

/// Warnings about gear parameters that do not fit together, with key, value and expected value. If the teeth jam, the
/// jam is the only warning. The function takes about 10 ms.
std::vector<std::string> gearWarnings(const Parameters& parameters);
}  // namespace hjt
