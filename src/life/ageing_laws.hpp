// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <boost/random/lognormal_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>

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

/// How old a drive is, by every way in which it ages.
struct DriveAge
{
  double turns{};  ///< of the wave generator
  /// Depth worn off both flanks of a pair, by the direction of the load that presses them: > 0, < 0 [m]
  std::array<double, 2> flank_wear{};
  double interface_wear{};  ///< depth worn off outer race and rim [m]
  double grease{};          ///< share of its life that the grease has behind it; 1: a change is due [-]
  double flaw_depth{};      ///< of the deepest crack at a tooth root; 0: none [m]
  double bearing_turns{};   ///< of the wave generator's bearing, in turns at rated torque
  std::array<double, STRESS_PLACES> fatigue{};  ///< Miner's sum of the flexspline by place; 1: broken [-]
  double filling_factor{ 1.0 };  ///< of the rates of wear in the present filling of grease, over the drive's median [-]

  double worstFlank() const { return std::max(flank_wear[0], flank_wear[1]); }  ///< [m]
  double meanFlank() const { return 0.5 * (flank_wear[0] + flank_wear[1]); }    ///< half the play's growth [m]
};

/// Standard deviation of the logarithm of a drive's rate of wear from one filling of grease to the next [-]. Assumed:
/// repeated wear tests of one pairing differ by factors of 1.3 to 2; 0.25 is about half of the logarithm of such.
constexpr double RATE_SCATTER = 0.25;

/// Standard deviation of the logarithm of the strength that the transition to the cup has beside the tooth space [-].
/// Its stress goes with stress.coning_restraint, which is known to 0.05: 0.34 of the logarithm (docs/life.md).
constexpr double TRANSITION_SCATTER = 0.3;

/// Differences of one drive from the nominal one: unknown from outside.
struct UnitVariation
{
  double flank_factor{ 1.0 };      ///< its flank wear over that of the nominal drive [-]
  double interface_factor{ 1.0 };  ///< its interface wear over that of the nominal drive [-]
  double bearing_life{};           ///< turns at rated torque until the bearing's first spall
  double spall_growth{};           ///< share of that life from the first spall to the end [-]
  double strength{ 1.0 };          ///< its flexspline's fatigue strength over the median's [-]
  double transition{ 1.0 };        ///< strength of the transition to its cup over that of the rest [-]
  std::uint32_t fillings{};        ///< seed of what differs from one filling of grease to the next; 0: nothing does
};

/// Of the drive's rates of wear in its n-th filling of grease, from 0 on, over its median [-].
inline double fillingFactor(const UnitVariation& variation, std::uint32_t number)
{
  if (variation.fillings == 0)
  {
    return 1.0;
  }
  constexpr std::uint32_t STRIDE = 0x9E3779B9u;
  boost::random::mt19937 random(variation.fillings + STRIDE * number);
  return boost::random::lognormal_distribution<double>(0.0, RATE_SCATTER)(random);
}

/// Fatigue strength of a drive at a place, over the median's [-].
inline double strengthOf(const UnitVariation& variation, std::size_t place)
{
  return place == static_cast<std::size_t>(StressPlace::TRANSITION) ? variation.strength * variation.transition :
                                                                      variation.strength;
}

/// Ends of a drive's use.
enum class EndOfLife
{
  FLANK_WEAR,
  INTERFACE_WEAR,
  ROOT_CRACK,
  BEARING,
  TOOTH_SPACE_FATIGUE,  // the fatigue of the places follows in their order
  TRANSITION_FATIGUE,
  FLANGE_FATIGUE
};

constexpr std::size_t ENDS_OF_LIFE = 7;

inline EndOfLife fatigueAt(std::size_t place)
{
  return static_cast<EndOfLife>(static_cast<std::size_t>(EndOfLife::TOOTH_SPACE_FATIGUE) + place);
}

/// Names: flank wear, interface wear, root crack, bearing, fatigue of tooth space, transition, flange; still in use.
inline const char* nameOf(const std::optional<EndOfLife>& end) noexcept
{
  constexpr std::array<const char*, ENDS_OF_LIFE> NAMES{ "flank wear",    "interface wear",      "root crack",
                                                         "bearing",       "tooth space fatigue", "transition fatigue",
                                                         "flange fatigue" };
  return end ? NAMES[static_cast<std::size_t>(*end)] : "still in use";
}

/// One drive out of many: factors of wear and strength log-normal, the bearing's life after the catalogue's Weibull
/// distribution.
template <class Engine>
UnitVariation drawVariation(const LifeParameters& parameters, const BearingLife& bearing, Engine& engine)
{
  boost::random::lognormal_distribution<double> wear(0.0, parameters.wear_spread);
  boost::random::lognormal_distribution<double> growth(std::log(parameters.spall_growth), parameters.spall_spread);
  boost::random::lognormal_distribution<double> strength(0.0, parameters.fatigue_spread);
  UnitVariation variation;
  variation.flank_factor = wear(engine);
  variation.interface_factor = wear(engine);
  variation.bearing_life = bearing.quantile(boost::random::uniform_01<double>()(engine));
  variation.spall_growth = growth(engine);
  variation.strength = strength(engine);
  variation.transition = boost::random::lognormal_distribution<double>(0.0, TRANSITION_SCATTER)(engine);
  variation.fillings = static_cast<std::uint32_t>(engine());
  return variation;
}

/// Size of the bearing's spall: 0 up to `bearing_life`, 1 at the end of use, between them as the square of the turns,
/// for a spall grows the faster the larger it is (assumed) [-].
inline double spallSize(const UnitVariation& variation, double bearing_turns)
{
  const double grown = (bearing_turns / variation.bearing_life - 1.0) / variation.spall_growth;
  return grown > 0.0 ? grown * grown : 0.0;
}
}  // namespace hjt
