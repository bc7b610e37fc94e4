// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <boost/random/lognormal_distribution.hpp>
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

  double worstFlank() const { return std::max(flank_wear[0], flank_wear[1]); }  ///< [m]
  double meanFlank() const { return 0.5 * (flank_wear[0] + flank_wear[1]); }    ///< half the play's growth [m]
};

/// Differences of one drive from the nominal one: unknown from outside, constant over its life.
struct UnitVariation
{
  double flank_factor{ 1.0 };      ///< its flank wear over that of the nominal drive [-]
  double interface_factor{ 1.0 };  ///< its interface wear over that of the nominal drive [-]
  double bearing_life{};           ///< turns at rated torque until the bearing's first spall
  double spall_growth{};           ///< share of that life from the first spall to the end [-]
  double strength{ 1.0 };          ///< its flexspline's fatigue strength over the median's [-]
};

/// What ends a drive's use.
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
