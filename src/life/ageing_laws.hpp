// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/statics/tooth_stress.hpp"

namespace hjt
{
/// Load of one turn of the wave generator at a steady load: forces, slips and stresses of the tooth
/// model, friction coefficients left out.
struct RevolutionLoad
{
  double flank_sliding{};      ///< force times sliding on the flanks of one tooth of the flexspline [N.m]
  double interface_sliding{};  ///< the same between the bearing's outer race and the whole rim [N.m]
  double race_creep{};         ///< way of the outer race round in the rim, > 0: as the wave generator turns [m]
  std::array<StressCycle, STRESS_PLACES> stress{};  ///< by place
  double bending_range{};  ///< of the bending stress in the tooth space, largest less smallest, nominal [Pa]
  double tension_range{};  ///< of the rim's tension likewise [Pa]
};

/// `of(x, y)` of all numbers of two loads.
template <class Of>
RevolutionLoad combined(const RevolutionLoad& a, const RevolutionLoad& b, Of&& of)
{
  RevolutionLoad result{ of(a.flank_sliding, b.flank_sliding), of(a.interface_sliding, b.interface_sliding),
                         of(a.race_creep, b.race_creep),       {},
                         of(a.bending_range, b.bending_range), of(a.tension_range, b.tension_range) };
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    result.stress[place] = { of(a.stress[place].lowest, b.stress[place].lowest),
                             of(a.stress[place].highest, b.stress[place].highest),
                             of(a.stress[place].shear, b.stress[place].shear) };
  }
  return result;
}

// How a drive ages: rates by the turns of the wave generator.

/// Archard's law: depth worn off a surface, k F s / A.
/// `coefficient` k [1/Pa], `sliding`: force times way [N.m], `area` [m^2]; [m].
inline double archardDepth(double coefficient, double sliding, double area)
{
  return coefficient * sliding / area;
}

/// Share of the grease's life that one turn takes at a temperature [degC], up to the rated torque: the maker's turns
/// between two changes, halved by every `grease_halving` kelvin above the temperature they hold for.
double greaseAgeing(const LifeParameters& parameters, double temperature);

/// How many times as fast grease ages under a torque: the maker's (T_av / T_N)^3 above the rated torque [-].
/// `mean_cube`: of the torque over the rated one.
inline double greaseLoadFactor(double mean_cube)
{
  return std::max(1.0, mean_cube);
}

/// By how much grease of an age wears the surfaces faster than fresh grease does: 1 when fresh, `grease_wear_factor` at
/// the change that is due, and on along the same straight line.
inline double greaseWearFactor(const LifeParameters& parameters, double age)
{
  return 1.0 + (parameters.grease_wear_factor - 1.0) * age;
}

/// The groups of a drive's parameters that the laws of ageing need.
struct AgeingParameters
{
  AgeingParameters(const Parameters& of) : gear(of.gear), stress(of.stress), life(of.life) {}

  GearParameters gear;
  StressParameters stress;
  LifeParameters life;
};

/// Range of the stress intensity at a crack across the tooth space [Pa sqrt(m)]: an edge crack in a strip (Tada). The
/// wave generator prescribes the rim's shape, so that a deeper crack leaves less bending to the section; the tension
/// stays. The notch raises the stress of a crack that is short against its radius (Lukas and Klesnil).
/// `depth` of the crack, >= 0 [m].
double stressIntensityRange(const AgeingParameters& parameters, const RevolutionLoad& revolution_load, double depth);

/// Paris' law with a threshold: growth of a crack by one turn [m]. The rim is bent twice a turn.
double crackGrowth(const AgeingParameters& parameters, const RevolutionLoad& revolution_load, double depth);

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
