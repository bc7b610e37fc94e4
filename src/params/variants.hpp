// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

// Drives that differ from a configured one in a single respect.
namespace hjt
{
/// Nothing hangs on the output: for a load torque that holds the weight already.
inline Parameters withoutWeight(Parameters parameters)
{
  parameters.output.gravity_torque = 0.0;
  return parameters;
}

/// The drive has the temperature it is given.
inline Parameters withoutHeat(Parameters parameters)
{
  parameters.thermal.model = ThermalModel::NONE;
  return parameters;
}

/// Coefficients of friction 1 at flanks and outer race: friction is then the force by which it is to be multiplied.
inline Parameters withUnitFriction(Parameters parameters)
{
  parameters.mesh.friction_static = 1.0;
  parameters.mesh.friction_kinetic = 1.0;
  parameters.contact.friction_coefficient = 1.0;
  return parameters;
}

/// All teeth are alike, and all spaces; the wave generator keeps its errors.
inline Parameters withEqualTeeth(Parameters parameters)
{
  ManufactureParameters& errors = parameters.manufacture;
  for (PitchParameters* pitch : { &errors.flexspline_pitch, &errors.circular_spline_pitch })
  {
    pitch->deviation = 0.0;
    pitch->table = NO_FILE;
  }
  errors.flexspline_eccentricity = {};
  errors.circular_spline_eccentricity = {};
  errors.circular_spline_ellipticity = {};
  return parameters;
}

/// Whether each tooth meets with what any other does, a pitch of the wave generator's turn later.
inline bool teethAreAlike(const Parameters& parameters)
{
  const ManufactureParameters& errors = parameters.manufacture;
  const auto is_even = [](const PitchParameters& pitch) { return pitch.deviation == 0.0 && pitch.table == NO_FILE; };
  const auto is_zero = [](const auto& vector) { return vector[0] == 0.0 && vector[1] == 0.0; };
  return is_even(errors.flexspline_pitch) && is_even(errors.circular_spline_pitch) &&
         is_zero(errors.flexspline_eccentricity) && is_zero(errors.circular_spline_eccentricity) &&
         is_zero(errors.circular_spline_ellipticity) && parameters.faults.empty();
}

/// The gear as drawn.
inline Parameters withoutErrors(const Parameters& parameters)
{
  Parameters drawn = withEqualTeeth(parameters);
  drawn.manufacture.wave_generator_eccentricity = {};
  drawn.manufacture.wave_generator_ellipticity = 0.0;
  return drawn;
}
}  // namespace hjt
