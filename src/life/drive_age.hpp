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

#include "life/ageing_laws.hpp"

namespace hjt
{
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
