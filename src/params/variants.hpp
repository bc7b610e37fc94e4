// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

// Each function returns the parameters of a drive that differs from the configured drive in one respect.
namespace hjt
{
/// Drive whose load has no weight, for a load torque that already contains the weight.
inline Parameters withoutWeight(Parameters parameters)
{
  parameters.output.gravity_torque = 0.0;
  return parameters;
}

/// Drive that keeps its given temperature, because the losses do not warm it.
inline Parameters withoutHeat(Parameters parameters)
{
  parameters.thermal.model = ThermalModel::NONE;
  return parameters;
}

/// Drive with friction coefficients of 1 at flanks and outer race. With a coefficient c the drive has c times this
/// friction torque.
inline Parameters withUnitFriction(Parameters parameters)
{
  parameters.mesh.friction_static = 1.0;
  parameters.mesh.friction_kinetic = 1.0;
  parameters.contact.friction_coefficient = 1.0;
  return parameters;
}

/// Drive with equal teeth and equal spaces. The errors of the wave generator stay.
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

/// Whether all teeth and all spaces are equal, without errors of manufacture and without configured faults.
inline bool teethAreAlike(const Parameters& parameters)
{
  const ManufactureParameters& errors = parameters.manufacture;
  const auto is_even = [](const PitchParameters& pitch) { return pitch.deviation == 0.0 && pitch.table == NO_FILE; };
  const auto is_zero = [](const auto& vector) { return vector[0] == 0.0 && vector[1] == 0.0; };
  return is_even(errors.flexspline_pitch) && is_even(errors.circular_spline_pitch) &&
         is_zero(errors.flexspline_eccentricity) && is_zero(errors.circular_spline_eccentricity) &&
         is_zero(errors.circular_spline_ellipticity) && parameters.faults.empty();
}

inline Parameters withoutErrors(const Parameters& parameters)
{
  Parameters drawn = withEqualTeeth(parameters);
  drawn.manufacture.wave_generator_eccentricity = {};
  drawn.manufacture.wave_generator_ellipticity = 0.0;
  return drawn;
}
}  // namespace hjt
