// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Lines by their order in cycles per turn of the motor, with the flexspline held and the circular spline turning. The
/// phase of a line with isPhaseLocked depends on motor and output angle alone and therefore stays from window to
/// window. Rolling elements slip, so that the phases of their lines drift.
///
/// A cracked tooth or rim yields only under load, in the direction of the load. Its line therefore changes sign with
/// the load and cancels out over both signs. FIRST_LOADED begins the lines in proportion to the load, with their
/// amplitude at rated torque. Their part that lags in time behind its cause changes sign with the direction of motion
/// and is a separate line.
enum class Line : std::size_t
{
  WAVE_GENERATOR_1,  ///< once a turn: eccentric wave generator
  WAVE_GENERATOR_2,  ///< each lobe passes a place of the flexspline
  WAVE_GENERATOR_4,  ///< harmonics of WAVE_GENERATOR_2
  WAVE_GENERATOR_6,
  WAVE_GENERATOR_8,
  CIRCULAR_SPLINE_2,  ///< each lobe passes a place of the circular spline
  CAGE_LOBES,         ///< each lobe passes a place of the cage
  CAGE_LOBES_DOUBLE,
  BALL,            ///< a place of a ball touches either race
  BALL_BELOW,      ///< order of BALL minus that of CAGE_LOBES, because the lobes load the ball; BALL_ABOVE: plus
  BALL_FAR_BELOW,  ///< order of BALL minus twice that of CAGE_LOBES
  BALL_ABOVE,
  OUTER,            ///< balls pass a place of the outer race
  OUTER_BELOW,      ///< order of OUTER minus two, because the two lobes load that place in turn; OUTER_ABOVE: plus two
  OUTER_FAR_BELOW,  ///< order of OUTER minus four
  OUTER_ABOVE,
  /// balls pass a place of the inner race; that place does not move relative to the lobes, so it has no sidebands
  INNER,
  INNER_DOUBLE,
  WAVE_GENERATOR_4_LOAD,  ///< in proportion to the load
  WAVE_GENERATOR_6_LOAD,
  WAVE_GENERATOR_8_LOAD,
  WAVE_GENERATOR_4_LOAD_LAG,  ///< in proportion to the load and the sign of the speed
  WAVE_GENERATOR_6_LOAD_LAG,
  WAVE_GENERATOR_8_LOAD_LAG,
  COUNT
};
constexpr auto LINE_COUNT = static_cast<std::size_t>(Line::COUNT);
constexpr auto FIRST_LOADED = static_cast<std::size_t>(Line::WAVE_GENERATOR_4_LOAD);
constexpr std::size_t LOADED_ORDERS = 3;  ///< number of orders from WAVE_GENERATOR_4 on
constexpr std::size_t LOADED_COUNT = 2 * LOADED_ORDERS;
constexpr std::size_t FIRST_LOCKED = 6;  ///< number of phase-locked lines without load
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

/// Law:   cage   f_c = (1 - s) (1 - d / D) / 2           outer race at rest, inner race with the motor
///        outer  Z f_c,   inner  Z (1 - f_c),   ball  twice (1 - s) D / (2 d) (1 - (d / D)^2)
///        lobe at a place of the cage  2 (1 - f_c),   of the circular spline  2 (1 - 1 / i)
/// where  d, D, Z  ball diameter, pitch diameter [m], balls [-];  i  nominal ratio [-];  s  `slip` of cage and
///        balls (bearing.cage_slip) [-]
/// Source: rolling-bearing kinematics, contact angle 0 (e.g. Harris, Rolling Bearing Analysis, ch. 25).
LineOrders trackedOrders(const GearParameters& gear, const BearingParameters& bearing, double slip = 0.0);
}  // namespace hjt
