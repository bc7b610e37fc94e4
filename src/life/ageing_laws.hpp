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
/// Forces, slips and stresses of the tooth model over one turn of the wave generator at constant load, for coefficients
/// of friction of 1.
struct RevolutionLoad
{
  double flank_sliding{};  ///< integral of force times sliding on the flanks of one tooth of the flexspline [N.m]
  /// integral of force times sliding between the bearing's outer race and the whole rim [N.m]
  double interface_sliding{};
  double race_creep{};  ///< creep of the outer race in the rim, > 0 in the direction of the wave generator [m]
  std::array<StressCycle, STRESS_PLACES> stress{};  ///< stress cycle at each place
  double bending_range{};  ///< largest minus smallest nominal bending stress in the tooth space [Pa]
  double tension_range{};  ///< largest minus smallest nominal tension stress of the rim [Pa]
};

/// The loads whose numbers are `of(x, y)` of the corresponding numbers x of `a` and y of `b`.
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

// The laws of ageing give rates per turn of the wave generator.

/// Archard's law: wear depth of a surface, k F s / A [m].
/// `coefficient`: k [1/Pa]; `sliding`: F s, force times distance [N.m]; `area`: A [m^2].
inline double archardDepth(double coefficient, double sliding, double area)
{
  return coefficient * sliding / area;
}

/// Share of the grease's life that one turn uses at a temperature [degC], up to the rated torque. The life is the
/// maker's number of turns, halved for every `grease_halving` kelvin above `grease_temperature`.
double greaseAgeing(const LifeParameters& parameters, double temperature);

/// Factor on the ageing of grease by the load [-]: the gear maker's (T_av / T_N)^3, at least 1, with T_av the average
/// torque and T_N the rated torque. `mean_cube`: mean of (torque / T_N)^3 over the turns.
inline double greaseLoadFactor(double mean_cube)
{
  return std::max(1.0, mean_cube);
}

/// Rate of wear over the rate with fresh grease [-]. This factor grows linearly with `age`, the used share of the
/// grease's life, from 1 to `grease_wear_factor` when a change of the grease is due.
inline double greaseWearFactor(const LifeParameters& parameters, double age)
{
  return 1.0 + (parameters.grease_wear_factor - 1.0) * age;
}

struct AgeingParameters
{
  AgeingParameters(const Parameters& of) : gear(of.gear), stress(of.stress), life(of.life) {}

  GearParameters gear;
  StressParameters stress;
  LifeParameters life;
};

/// Range of the stress intensity at a crack across the tooth space [Pa sqrt(m)], for an edge crack in a strip (Tada).
/// The wave generator prescribes the rim's shape, so that a deeper crack reduces the bending moment of the section, but
/// not the tension. The notch at the tooth root increases the stress if the crack is short compared with the notch
/// radius (Lukas and Klesnil). `depth`: depth of the crack, >= 0 [m].
double stressIntensityRange(const AgeingParameters& parameters, const RevolutionLoad& revolution_load, double depth);

/// Growth of a crack of `depth` [m] in one turn, by Paris' law with a threshold [m]. The rim bends twice in a turn.
double crackGrowth(const AgeingParameters& parameters, const RevolutionLoad& revolution_load, double depth);

/// Number of turns at rated torque that wear the wave generator's bearing as much as one turn under `load_torque`
/// [N.m]. The bearing's life in turns is in inverse proportion to the cube of the torque.
double bearingWear(const LifeParameters& parameters, double load_torque);

/// Life of the bearing in turns at rated torque: a Weibull distribution with the catalogue's L10 and L50.
struct BearingLife
{
  double shape;  ///< Weibull slope [-]
  double scale;  ///< characteristic life, at which 63.2 % have failed [turns at rated torque]

  explicit BearingLife(const LifeParameters& parameters);

  /// Life in turns at rated torque that a share `failed` of all bearings does not exceed, 0 < failed < 1.
  double quantile(double failed) const;
  /// Share of all bearings that have failed after a number of turns at rated torque [-].
  double failedBy(double turns) const;
};

/// Age of a drive by each mechanism of ageing.
struct DriveAge
{
  double turns{};  ///< turns of the wave generator
  /// Wear depth of both flanks of a pair together, for loads > 0 and for loads < 0 [m].
  std::array<double, 2> flank_wear{};
  double interface_wear{};  ///< wear depth of outer race and rim [m]
  double grease{};          ///< used share of the grease's life; 1: a change is due [-]
  double flaw_depth{};      ///< depth of the deepest crack at a tooth root; 0: none [m]
  double bearing_turns{};   ///< turns at rated torque that wear the wave generator's bearing as much as the use
  std::array<double, STRESS_PLACES> fatigue{};  ///< Miner's sum of the flexspline by place; 1: broken [-]
  double filling_factor{ 1.0 };  ///< rate of wear in the current filling of grease over the drive's median [-]

  /// larger of the wear depths for the two load directions [m]
  double worstFlank() const { return std::max(flank_wear[0], flank_wear[1]); }
  /// mean of the wear depths for the two load directions, which is half of the growth of the play [m]
  double meanFlank() const { return 0.5 * (flank_wear[0] + flank_wear[1]); }
};

/// Standard deviation of the logarithm of a drive's rate of wear from one filling of grease to the next [-].
/// Assumption: repeated wear tests of one pairing differ by factors of 1.3 to 2, of whose logarithm 0.25 is about half.
constexpr double RATE_SCATTER = 0.25;

/// Standard deviation of the logarithm of the transition's strength relative to that of the tooth space [-]. The stress
/// at the transition depends on stress.coning_restraint, whose uncertainty of 0.05 changes the logarithm by 0.34
/// (docs/life.md).
constexpr double TRANSITION_SCATTER = 0.3;

/// Differences of one drive from the nominal drive. Sensors outside the drive cannot measure these differences.
struct UnitVariation
{
  double flank_factor{ 1.0 };      ///< flank wear over that of the nominal drive [-]
  double interface_factor{ 1.0 };  ///< interface wear over that of the nominal drive [-]
  double bearing_life{};           ///< turns at rated torque until the bearing's first spall
  double spall_growth{};           ///< turns from the first spall to the end of use, as a share of bearing_life [-]
  double strength{ 1.0 };          ///< fatigue strength of the flexspline over the median [-]
  double transition{ 1.0 };        ///< strength of the transition to the cup over the strength of other places [-]
  std::uint32_t fillings{};        ///< seed of the differences between fillings of grease; 0: no differences
};

/// Rate of wear in a filling of grease over the drive's median rate [-]. `number`: number of the filling, from 0 on.
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

/// Fatigue strength of a drive at a place over the median of all drives [-].
inline double strengthOf(const UnitVariation& variation, std::size_t place)
{
  return place == static_cast<std::size_t>(StressPlace::TRANSITION) ? variation.strength * variation.transition :
                                                                      variation.strength;
}

/// Mechanisms that end a drive's use.
enum class EndOfLife
{
  FLANK_WEAR,
  INTERFACE_WEAR,
  ROOT_CRACK,
  BEARING,
  TOOTH_SPACE_FATIGUE,  // followed by the fatigue of the other places of the flexspline, in the order of StressPlace
  TRANSITION_FATIGUE,
  FLANGE_FATIGUE
};

constexpr std::size_t ENDS_OF_LIFE = 7;

inline EndOfLife fatigueAt(std::size_t place)
{
  return static_cast<EndOfLife>(static_cast<std::size_t>(EndOfLife::TOOTH_SPACE_FATIGUE) + place);
}

/// Name of the end of life; "still in use" if there is none.
inline const char* nameOf(const std::optional<EndOfLife>& end) noexcept
{
  constexpr std::array<const char*, ENDS_OF_LIFE> NAMES{ "flank wear",    "interface wear",      "root crack",
                                                         "bearing",       "tooth space fatigue", "transition fatigue",
                                                         "flange fatigue" };
  return end ? NAMES[static_cast<std::size_t>(*end)] : "still in use";
}

/// Draws a drive at random: log-normal factors of wear, spall growth and strength, and the bearing's life from the
/// Weibull distribution of the catalogue.
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

/// Severity of the bearing's spall [-]: 0 up to `bearing_life`, 1 at the end of use, in between quadratic in the turns,
/// because a larger spall grows faster (assumption). `bearing_turns`: DriveAge::bearing_turns.
inline double spallSize(const UnitVariation& variation, double bearing_turns)
{
  const double grown = (bearing_turns / variation.bearing_life - 1.0) / variation.spall_growth;
  return grown > 0.0 ? grown * grown : 0.0;
}
}  // namespace hjt
