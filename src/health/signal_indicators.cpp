// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/signal_indicators.hpp"

#include <cmath>
#include <string>

#include "gear/ratio.hpp"
#include "health/indicator_table.hpp"

namespace hjt
{
namespace
{
struct Label
{
  std::string name;
  std::string unit;
};

constexpr std::array<std::array<const char*, 2>, LINE_SIGNALS> SIGNALS{ {
    { "error", "rad" },
    { "torque", "N.m" },
    { "ripple", "rad" },
} };

std::array<Label, INDICATOR_COUNT> makeLabels()
{
  std::array<Label, INDICATOR_COUNT> labels;
  for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
  {
    labels[i] = { SCALARS[i].name, SCALARS[i].unit };
  }
  for (std::size_t s = 0; s < LINE_SIGNALS; ++s)
  {
    const auto signal = static_cast<LineSignal>(s);
    for (std::size_t line = 0; line < LINE_COUNT && hasLine(signal, line); ++line)
    {
      const std::string name = std::string(SIGNALS[s][0]) + "_" + LINES[line].name;
      labels[amplitudeIndex(signal, line)] = { name, SIGNALS[s][1] };
      if (isPhaseLocked(line))
      {
        labels[cosineIndex(signal, line)] = { name + "_cos", SIGNALS[s][1] };
        labels[sineIndex(signal, line)] = { name + "_sin", SIGNALS[s][1] };
      }
    }
  }
  return labels;
}

const std::array<Label, INDICATOR_COUNT> LABELS = makeLabels();
}  // namespace

const char* indicatorName(std::size_t indicator) noexcept
{
  return LABELS[indicator].name.c_str();
}

const char* indicatorUnit(std::size_t indicator) noexcept
{
  return LABELS[indicator].unit.c_str();
}

double SignalIndicators::phase(LineSignal signal, Line line) const noexcept
{
  if (!isPhaseLocked(index(line)) || !hasLine(signal, index(line)))
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  // a cos x + b sin x = A cos(x + phase)
  return std::atan2(-values[sineIndex(signal, index(line))], values[cosineIndex(signal, index(line))]);
}

SignalIndicators difference(const SignalIndicators& measured, const SignalIndicators& model) noexcept
{
  SignalIndicators result = measured;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    result.values[i] -= model.values[i];
    result.uncertainty[i] = std::hypot(measured.uncertainty[i], model.uncertainty[i]);
  }
  for (const LineSignal signal : ALL_LINE_SIGNALS)
  {
    for (std::size_t line = 0; line < LINE_COUNT && hasLine(signal, line); ++line)
    {
      if (isPhaseLocked(line))
      {
        result.values[amplitudeIndex(signal, line)] =
            std::hypot(result.values[cosineIndex(signal, line)], result.values[sineIndex(signal, line)]);
      }
    }
  }
  return result;
}

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
