// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Lines by cycles per turn of the motor, flexspline held, circular spline turning. The first PHASE_LOCKED of them
/// follow from the two angles alone, so that their phase stays from window to window; rolling elements creep, theirs
/// does not.
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
  OUTER_BELOW,      ///< less and plus two: the lobes load that place
  OUTER_FAR_BELOW,  ///< less four
  OUTER_ABOVE,
  INNER,  ///< balls over a place of the inner race, which stands still against the lobes: no lines beside it
  INNER_DOUBLE,
  COUNT
};
constexpr auto LINE_COUNT = static_cast<std::size_t>(Line::COUNT);
constexpr std::size_t PHASE_LOCKED = 6;

constexpr std::size_t index(Line line)
{
  return static_cast<std::size_t>(line);
}

using LineOrders = std::array<double, LINE_COUNT>;  ///< [1/turn of the motor]

/// Law:   cage   f_c = (1 - d / D) / 2                   outer race standing, inner race with the motor
///        outer  Z f_c,   inner  Z (1 - f_c),   ball  twice D / (2 d) (1 - (d / D)^2)
///        lobe at a place of the cage  2 (1 - f_c),   of the circular spline  2 (1 - 1 / i)
/// where  d, D, Z  ball diameter, pitch diameter [m], balls [-];  i  nominal ratio [-]
/// Source: rolling-bearing kinematics without slip, contact angle 0 (e.g. Harris, Rolling Bearing Analysis, ch. 25).
LineOrders trackedOrders(const GearParameters& gear, const BearingParameters& bearing);
}  // namespace hjt
