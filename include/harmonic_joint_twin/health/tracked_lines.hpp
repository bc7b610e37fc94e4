// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Lines by cycles per turn of the motor, flexspline held, circular spline turning. Those that isPhaseLocked follow
/// from the two angles alone, so that their phase stays from window to window; rolling elements creep, theirs does not.
///
/// A cracked tooth or rim gives way under load alone, to the side that the load pushes it to: its line changes sign
/// with the load and vanishes in the mean of a motion through both. The share of a line that is in proportion to the
/// load, as it is at the rated torque, is therefore a line of its own, from FIRST_LOADED on. A share that lags in time
/// behind its cause also changes sign with the direction; that is another one.
enum class Line : std::size_t
{
  WAVE_GENERATOR_1,  ///< once a turn: eccentric wave generator
  WAVE_GENERATOR_2,  ///< each lobe at a place of the flexspline
  WAVE_GENERATOR_4,  ///< its harmonics
  WAVE_GENERATOR_6,
  WAVE_GENERATOR_8,
  CIRCULAR_SPLINE_2,  ///< each lobe at a place of the circular spline
  CAGE_LOBES,         ///< each lobe at a place of the cage
  CAGE_LOBES_DOUBLE,
  BALL,            ///< a place on a ball against either race
  BALL_BELOW,      ///< less and plus the lobes over the cage: they load the ball
  BALL_FAR_BELOW,  ///< less twice these
  BALL_ABOVE,
  OUTER,            ///< balls over a place of the outer race
  OUTER_BELOW,      ///< OUTER less two, OUTER_ABOVE plus two: the two lobes load that place in turn
  OUTER_FAR_BELOW,  ///< less four
  OUTER_ABOVE,
  INNER,  ///< balls over a place of the inner race, which stands still against the lobes: no lines beside it
  INNER_DOUBLE,
  WAVE_GENERATOR_4_LOAD,  ///< in proportion to the load
  WAVE_GENERATOR_6_LOAD,
  WAVE_GENERATOR_8_LOAD,
  WAVE_GENERATOR_4_LOAD_LAG,  ///< and to the sign of the speed
  WAVE_GENERATOR_6_LOAD_LAG,
  WAVE_GENERATOR_8_LOAD_LAG,
  COUNT
};
constexpr auto LINE_COUNT = static_cast<std::size_t>(Line::COUNT);
constexpr auto FIRST_LOADED = static_cast<std::size_t>(Line::WAVE_GENERATOR_4_LOAD);
constexpr std::size_t LOADED_ORDERS = 3;  ///< those of the lines from WAVE_GENERATOR_4 on
constexpr std::size_t LOADED_COUNT = 2 * LOADED_ORDERS;
constexpr std::size_t FIRST_LOCKED = 6;  ///< so many of those without load
static_assert(FIRST_LOADED + LOADED_COUNT == LINE_COUNT);

constexpr bool isPhaseLocked(std::size_t line)
{
  return line < FIRST_LOCKED || line >= FIRST_LOADED;
}

constexpr std::size_t index(Line line)
{
  return static_cast<std::size_t>(line);
}

using LineOrders = std::array<double, LINE_COUNT>;  ///< [1/turn of the motor]

/// Law:   cage   f_c = (1 - s) (1 - d / D) / 2           outer race standing, inner race with the motor
///        outer  Z f_c,   inner  Z (1 - f_c),   ball  twice (1 - s) D / (2 d) (1 - (d / D)^2)
///        lobe at a place of the cage  2 (1 - f_c),   of the circular spline  2 (1 - 1 / i)
/// where  d, D, Z  ball diameter, pitch diameter [m], balls [-];  i  nominal ratio [-];  s  `slip` of cage and
///        balls (bearing.cage_slip) [-]
/// Source: rolling-bearing kinematics, contact angle 0 (e.g. Harris, Rolling Bearing Analysis, ch. 25).
LineOrders trackedOrders(const GearParameters& gear, const BearingParameters& bearing, double slip = 0.0);
}  // namespace hjt
