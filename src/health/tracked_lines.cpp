// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/tracked_lines.hpp"

#include "gear/ratio.hpp"

namespace hjt
{
LineOrders trackedOrders(const GearParameters& gear, const BearingParameters& bearing, double slip)
{
  constexpr double LOBES = 2.0;
  const double share = bearing.ball_diameter / bearing.pitch_diameter;
  const double cage = 0.5 * (1.0 - slip) * (1.0 - share);
  const double ball = (1.0 - slip) * (1.0 / share - share);
  const double outer = bearing.balls * cage;
  const double inner = bearing.balls * (1.0 - cage);
  const double cage_lobes = LOBES * (1.0 - cage);
  LineOrders orders{};
  const auto set = [&orders](Line line, double order) { orders[index(line)] = order; };
  set(Line::WAVE_GENERATOR_1, 1.0);
  set(Line::WAVE_GENERATOR_2, LOBES);
  set(Line::WAVE_GENERATOR_4, 2.0 * LOBES);
  set(Line::WAVE_GENERATOR_6, 3.0 * LOBES);
  set(Line::WAVE_GENERATOR_8, 4.0 * LOBES);
  set(Line::CIRCULAR_SPLINE_2, LOBES * (1.0 - 1.0 / nominalRatio(gear)));
  set(Line::CAGE_LOBES, cage_lobes);
  set(Line::CAGE_LOBES_DOUBLE, 2.0 * cage_lobes);
  set(Line::BALL, ball);
  set(Line::BALL_BELOW, ball - cage_lobes);
  set(Line::BALL_FAR_BELOW, ball - 2.0 * cage_lobes);
  set(Line::BALL_ABOVE, ball + cage_lobes);
  set(Line::OUTER, outer);
  set(Line::OUTER_BELOW, outer - LOBES);
  set(Line::OUTER_FAR_BELOW, outer - 2.0 * LOBES);
  set(Line::OUTER_ABOVE, outer + LOBES);
  set(Line::INNER, inner);
  set(Line::INNER_DOUBLE, 2.0 * inner);
  for (std::size_t i = 0; i < LOADED_COUNT; ++i)
  {
    orders[FIRST_LOADED + i] = orders[index(Line::WAVE_GENERATOR_4) + i % LOADED_ORDERS];
  }
  return orders;
}
}  // namespace hjt
