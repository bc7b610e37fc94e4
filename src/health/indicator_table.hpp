// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "harmonic_joint_twin/health/fault_signatures.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"

namespace hjt
{
/// Whether a table has a row for each value of an enumeration, in the order of the enumeration; for static_assert.
template <class Rows, class Row, class Key>
constexpr bool isInOrder(const Rows& rows, Key Row::*key)
{
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    if (static_cast<std::size_t>(rows[i].*key) != i)
    {
      return false;
    }
  }
  return true;
}

/// Unit of ScalarRow::floor, the least spread that the assessment assumes for a sound drive's indicator.
enum class FloorUnit
{
  INDICATOR,       ///< unit of the indicator itself
  ENCODER_COUNT,   ///< root of the sum of squares of one count of each encoder, as angles of the joint [rad]
  COUNT_IN_A_TURN  ///< ENCODER_COUNT over the angle of the joint in one turn of the motor [-]
};

struct ScalarRow
{
  ScalarIndicator indicator;
  const char* name;
  const char* unit;
  Feature feature;  ///< group of the indicator; only the largest score of a group counts
  double floor{};   ///< least spread that the assessment assumes for a sound drive, in `floor_unit`
  FloorUnit floor_unit{};
};

/// Error of an indicator by the resolution of the encoders in a window, over FloorUnit::ENCODER_COUNT [-].
constexpr double COUNT_SHARE = 0.1;

/// Properties of the scalar indicators, for the assessment, messages and files.
inline constexpr std::array<ScalarRow, SCALAR_COUNT> SCALARS{ {
    { ScalarIndicator::RATIO_DEVIATION, "ratio_deviation", "-", Feature::RATIO, COUNT_SHARE,
      FloorUnit::COUNT_IN_A_TURN },
    { ScalarIndicator::KINEMATIC_ERROR, "kinematic_error", "rad", Feature::KINEMATIC_ERROR, COUNT_SHARE,
      FloorUnit::ENCODER_COUNT },
    { ScalarIndicator::TORSIONAL_STIFFNESS, "torsional_stiffness", "N.m/rad", Feature::STIFFNESS },
    { ScalarIndicator::SECOND_STIFFNESS, "second_stiffness", "N.m/rad", Feature::STIFFNESS },
    { ScalarIndicator::LOST_MOTION, "lost_motion", "rad", Feature::LOST_MOTION, COUNT_SHARE, FloorUnit::ENCODER_COUNT },
    { ScalarIndicator::HYSTERESIS, "hysteresis", "rad", Feature::LOOP_AREA, COUNT_SHARE, FloorUnit::ENCODER_COUNT },
    { ScalarIndicator::HYSTERESIS_AREA, "hysteresis_area", "J", Feature::LOOP_AREA },
    { ScalarIndicator::RUNNING_TORQUE, "running_torque", "N.m", Feature::RUNNING_TORQUE },
    { ScalarIndicator::COULOMB_TORQUE, "coulomb_torque", "N.m", Feature::COULOMB },
    { ScalarIndicator::VISCOUS_FRICTION, "viscous_friction", "N.m.s/rad", Feature::VISCOUS },
    { ScalarIndicator::EFFICIENCY, "efficiency", "-", Feature::EFFICIENCY },
    { ScalarIndicator::RESIDUAL_RMS, "residual_rms", "rad", Feature::RESIDUAL, COUNT_SHARE, FloorUnit::ENCODER_COUNT },
    // Kurtosis and crest of the residual are not normally distributed. The assessment therefore assumes a large spread.
    { ScalarIndicator::RESIDUAL_KURTOSIS, "residual_kurtosis", "-", Feature::IMPULSES, 0.3, FloorUnit::INDICATOR },
    { ScalarIndicator::RESIDUAL_CREST, "residual_crest", "-", Feature::IMPULSES, 0.5, FloorUnit::INDICATOR },
    { ScalarIndicator::LOAD_FRICTION, "load_friction", "-", Feature::EFFICIENCY },
    { ScalarIndicator::LAG_RIPPLE, "lag_ripple", "rad", Feature::RESIDUAL },
    { ScalarIndicator::LAG_ORDER_1, "lag_order_1", "rad", Feature::ORDER_1 },
    { ScalarIndicator::LAG_ORDER_2, "lag_order_2", "rad", Feature::ORDER_2 },
    { ScalarIndicator::LAG_ORDER_4, "lag_order_4", "rad", Feature::ORDER_4 },
} };
static_assert(isInOrder(SCALARS, &ScalarRow::indicator), "SCALARS must have a row for each ScalarIndicator, in order");

/// Signal of a line, for an indicator that is the amplitude, cosine part or sine part of the line.
constexpr LineSignal signalOf(std::size_t indicator)
{
  return indicator < LOADED_BLOCK ? ALL_LINE_SIGNALS[(indicator - SCALAR_COUNT) / LINE_BLOCK] :
                                    LineSignal::MOTOR_RIPPLE;
}

/// For the cosine or sine part of a line, the index of the line's amplitude; for other indicators, `indicator` itself.
constexpr std::size_t amplitudeOf(std::size_t indicator)
{
  const bool loaded = indicator >= LOADED_BLOCK;
  const std::size_t lines = loaded ? LOADED_COUNT : FIRST_LOADED;
  const std::size_t place = loaded ? indicator - LOADED_BLOCK : (indicator - SCALAR_COUNT) % LINE_BLOCK;
  return indicator < SCALAR_COUNT || place < lines ? indicator : indicator - place + (place - lines) / 2;
}

struct LineRow
{
  Line line;
  const char* name;
  Feature feature;
};

/// Names and groups of the lines. A line is an indicator of each LineSignal for which hasLine is true.
inline constexpr std::array<LineRow, LINE_COUNT> LINES{ {
    { Line::WAVE_GENERATOR_1, "wave_generator_1", Feature::ORDER_1 },
    { Line::WAVE_GENERATOR_2, "wave_generator_2", Feature::ORDER_2 },
    { Line::WAVE_GENERATOR_4, "wave_generator_4", Feature::ORDER_4 },
    { Line::WAVE_GENERATOR_6, "wave_generator_6", Feature::ORDER_6 },
    { Line::WAVE_GENERATOR_8, "wave_generator_8", Feature::ORDER_8 },
    { Line::CIRCULAR_SPLINE_2, "circular_spline_2", Feature::ORDER_CIRCULAR_SPLINE },
    { Line::CAGE_LOBES, "cage_lobes", Feature::CAGE },
    { Line::CAGE_LOBES_DOUBLE, "cage_lobes_double", Feature::CAGE },
    { Line::BALL, "ball", Feature::BALL },
    { Line::BALL_BELOW, "ball_below", Feature::BALL },
    { Line::BALL_FAR_BELOW, "ball_far_below", Feature::BALL },
    { Line::BALL_ABOVE, "ball_above", Feature::BALL },
    { Line::OUTER, "outer", Feature::OUTER },
    { Line::OUTER_BELOW, "outer_below", Feature::OUTER },
    { Line::OUTER_FAR_BELOW, "outer_far_below", Feature::OUTER },
    { Line::OUTER_ABOVE, "outer_above", Feature::OUTER },
    { Line::INNER, "inner", Feature::INNER },
    { Line::INNER_DOUBLE, "inner_double", Feature::INNER },
    { Line::WAVE_GENERATOR_4_LOAD, "wave_generator_4_load", Feature::ORDER_4 },
    { Line::WAVE_GENERATOR_6_LOAD, "wave_generator_6_load", Feature::ORDER_6 },
    { Line::WAVE_GENERATOR_8_LOAD, "wave_generator_8_load", Feature::ORDER_8 },
    { Line::WAVE_GENERATOR_4_LOAD_LAG, "wave_generator_4_load_lag", Feature::ORDER_4 },
    { Line::WAVE_GENERATOR_6_LOAD_LAG, "wave_generator_6_load_lag", Feature::ORDER_6 },
    { Line::WAVE_GENERATOR_8_LOAD_LAG, "wave_generator_8_load_lag", Feature::ORDER_8 },
} };
static_assert(isInOrder(LINES, &LineRow::line), "LINES must have a row for each Line, in order");
}  // namespace hjt
