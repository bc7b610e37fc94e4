// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "harmonic_joint_twin/health/tracked_lines.hpp"

namespace hjt
{
/// Indicators from encoders and torque alone. docs/indicators.md gives formulas and windows, and the faults that change
/// each indicator. The array of values continues, for each LineSignal, with the amplitudes of all tracked lines and
/// with the cosine and sine parts of the phase-locked lines.
enum class ScalarIndicator : std::size_t
{
  RATIO_DEVIATION,
  KINEMATIC_ERROR,
  TORSIONAL_STIFFNESS,
  SECOND_STIFFNESS,
  LOST_MOTION,
  HYSTERESIS,
  HYSTERESIS_AREA,
  RUNNING_TORQUE,
  COULOMB_TORQUE,
  VISCOUS_FRICTION,
  EFFICIENCY,
  RESIDUAL_RMS,
  RESIDUAL_KURTOSIS,
  RESIDUAL_CREST,
  LOAD_FRICTION,
  LAG_RIPPLE,
  LAG_ORDER_1,
  LAG_ORDER_2,
  LAG_ORDER_4,
  COUNT
};

/// Signal whose spectrum contains the lines.
enum class LineSignal : std::size_t
{
  KINEMATIC_ERROR,
  MOTOR_TORQUE,
  MOTOR_RIPPLE  ///< motion of the motor above the control bandwidth, which the torque therefore does not contain
};
inline constexpr std::array ALL_LINE_SIGNALS{ LineSignal::KINEMATIC_ERROR, LineSignal::MOTOR_TORQUE,
                                              LineSignal::MOTOR_RIPPLE };
constexpr std::size_t LINE_SIGNALS = ALL_LINE_SIGNALS.size();

/// Lines in proportion to the load are computed of MOTOR_RIPPLE only: in torsion and current they are below the noise.
constexpr bool hasLine(LineSignal signal, std::size_t line)
{
  return line < FIRST_LOADED || signal == LineSignal::MOTOR_RIPPLE;
}

constexpr auto SCALAR_COUNT = static_cast<std::size_t>(ScalarIndicator::COUNT);
constexpr std::size_t LINE_BLOCK = FIRST_LOADED + 2 * FIRST_LOCKED;
/// index of the first line in proportion to the load
constexpr std::size_t LOADED_BLOCK = SCALAR_COUNT + LINE_SIGNALS * LINE_BLOCK;
constexpr std::size_t INDICATOR_COUNT = LOADED_BLOCK + 3 * LOADED_COUNT;

constexpr std::size_t indexOf(ScalarIndicator indicator)
{
  return static_cast<std::size_t>(indicator);
}
constexpr std::size_t amplitudeIndex(LineSignal signal, std::size_t line)  ///< for lines with hasLine
{
  return line < FIRST_LOADED ? SCALAR_COUNT + static_cast<std::size_t>(signal) * LINE_BLOCK + line :
                               LOADED_BLOCK + line - FIRST_LOADED;
}
constexpr std::size_t cosineIndex(LineSignal signal, std::size_t line)  ///< for lines with hasLine and isPhaseLocked
{
  return line < FIRST_LOADED ? amplitudeIndex(signal, 0) + FIRST_LOADED + 2 * line :
                               LOADED_BLOCK + LOADED_COUNT + 2 * (line - FIRST_LOADED);
}
constexpr std::size_t sineIndex(LineSignal signal, std::size_t line)
{
  return cosineIndex(signal, line) + 1;
}

/// Whether the indicator is the amplitude of a line that is not phase-locked.
constexpr bool isFreeAmplitude(std::size_t indicator)
{
  return indicator >= SCALAR_COUNT && indicator < LOADED_BLOCK &&
         (indicator - SCALAR_COUNT) % LINE_BLOCK >= FIRST_LOCKED &&
         (indicator - SCALAR_COUNT) % LINE_BLOCK < FIRST_LOADED;
}

/// Name in snake case, as in Indicators.msg: "torsional_stiffness", "error_wave_generator_2",
/// "torque_wave_generator_2_cos". The text is static.
const char* indicatorName(std::size_t indicator) noexcept;
const char* indicatorUnit(std::size_t indicator) noexcept;

/// Motion and load of the joint in a window, as means over the window.
struct OperatingPoint
{
  double speed{};        ///< magnitude of the motor's speed [rad/s]
  double direction{};    ///< share of forward travel minus share of backward travel: -1 ... 1 [-]
  double load{};         ///< magnitude of the load torque; NaN: not estimated [N.m]
  double temperature{};  ///< NaN: not measured [degC]
  /// part of the load torque that does not depend on the output angle; NaN: not estimated [N.m]
  double load_constant{};
  double load_sine{};  ///< coefficient of the load torque for the sine of the output angle; NaN: not estimated [N.m]
  /// coefficient of the load torque for the cosine of the output angle; NaN: not estimated [N.m]
  double load_cosine{};
  double inertia{};  ///< inertia at the joint, the drive's own included: motor torque over acceleration [kg.m^2]
};

/// All indicators of one window. NaN: the window does not determine the indicator.
struct SignalIndicators
{
  SignalIndicators() { values.fill(std::numeric_limits<double>::quiet_NaN()); }

  double operator[](ScalarIndicator indicator) const noexcept { return values[indexOf(indicator)]; }
  double amplitude(LineSignal signal, Line line) const noexcept { return values[amplitudeIndex(signal, index(line))]; }
  /// phase of a cosine at motor angle 0; NaN if the line is not phase-locked [rad]
  double phase(LineSignal signal, Line line) const noexcept;

  std::int64_t stamp{};     ///< end of the window [ns]
  std::uint64_t windows{};  ///< windows completed since start or reset, this one included; 0: none yet
  double turns{};           ///< turns of the motor at constant speed in the window [-]
  OperatingPoint point;
  std::array<double, INDICATOR_COUNT> values{};
  /// standard error of the fit in the unit of the value; 0: not known
  std::array<double, INDICATOR_COUNT> uncertainty{};
};

/// Subtracts the indicators of a model with the same inputs from `measured`. The amplitude of a phase-locked line
/// becomes that of the complex difference, not the difference of the amplitudes.
SignalIndicators difference(const SignalIndicators& measured, const SignalIndicators& model) noexcept;
}  // namespace hjt
