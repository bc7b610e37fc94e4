// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// What one turn of the wave generator at a steady load does to the drive: forces, slips and stresses of the tooth
/// model, friction coefficients left out.
struct RevolutionLoad
{
  double flank_sliding{};      ///< force times sliding on the flanks of one tooth of the flexspline [N.m]
  double interface_sliding{};  ///< the same between the bearing's outer race and the whole rim [N.m]
  double rim_stress_range{};   ///< bending and tension at the root of the teeth, largest less smallest [Pa]
};

// How a drive ages: rates by the turns of the wave generator.

/// Archard's law: depth worn off a surface, k F s / A.
/// `coefficient` k [1/Pa], `sliding`: force times way [N.m], `area` [m^2]; [m].
inline double archardDepth(double coefficient, double sliding, double area)
{
  return coefficient * sliding / area;
}

/// Share of the grease's life that one turn takes at a temperature [degC]: the maker's turns between two changes,
/// halved by every `grease_halving` kelvin above the temperature they hold for.
double greaseAgeing(const LifeParameters& parameters, double temperature);

/// By how much grease of an age wears the surfaces faster than fresh grease does: 1 when fresh, `grease_wear_factor` at
/// the change that is due, and on along the same straight line.
inline double greaseWearFactor(const LifeParameters& parameters, double age)
{
  return 1.0 + (parameters.grease_wear_factor - 1.0) * age;
}

/// Range of the stress intensity at a flaw of the tooth's root, 1.12 K_t ds sqrt(pi a) [Pa sqrt(m)].
/// `stress_range` of the smooth rim [Pa], `depth` of the flaw [m].
double stressIntensityRange(const LifeParameters& parameters, double stress_range, double depth);

/// Paris' law with a threshold: growth of a flaw by one turn [m]. The rim is bent twice a turn.
double crackGrowth(const LifeParameters& parameters, double stress_range, double depth);

/// Turns at the catalogue's rated torque and speed that one turn under `load_torque` [N.m] is worth to the wave
/// generator's bearing: its life falls with the cube of the torque.
double bearingWear(const LifeParameters& parameters, double load_torque);

/// Life of the bearing in such turns: L10 and L50 of the catalogue fix a Weibull distribution.
struct BearingLife
{
  double shape;  ///< Weibull slope [-]
  double scale;  ///< characteristic life: 63.2 % have failed [turns at rated torque]

  explicit BearingLife(const LifeParameters& parameters);

  /// Turns by which a share `failed` of all bearings has failed, 0 < failed < 1.
  double quantile(double failed) const;
  /// Share of all bearings that has failed by then.
  double failedBy(double turns) const;
};
}  // namespace hjt
