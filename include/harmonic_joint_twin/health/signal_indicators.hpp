// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "harmonic_joint_twin/health/tracked_lines.hpp"

namespace hjt
{
/// Indicators out of encoders and torque alone; formulas, windows and the faults they answer to in docs/indicators.md.
/// After these scalars come, for each LineSignal, the amplitude of every tracked line and the cosine and sine parts of
/// the lines whose phase stays.
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

/// Signal that a line is taken from.
enum class LineSignal : std::size_t
{
  KINEMATIC_ERROR,
  MOTOR_TORQUE,
  MOTOR_RIPPLE  ///< of its angle: what is too fast for the drive's control and so not in the torque
};
inline constexpr std::array ALL_LINE_SIGNALS{ LineSignal::KINEMATIC_ERROR, LineSignal::MOTOR_TORQUE,
                                              LineSignal::MOTOR_RIPPLE };
constexpr std::size_t LINE_SIGNALS = ALL_LINE_SIGNALS.size();

/// Lines in proportion to the load are sought in the ripple alone: torsion and current show less of them than noise.
constexpr bool hasLine(LineSignal signal, std::size_t line)
{
  return line < FIRST_LOADED || signal == LineSignal::MOTOR_RIPPLE;
}

constexpr auto SCALAR_COUNT = static_cast<std::size_t>(ScalarIndicator::COUNT);
constexpr std::size_t LINE_BLOCK = FIRST_LOADED + 2 * FIRST_LOCKED;
constexpr std::size_t LOADED_BLOCK = SCALAR_COUNT + LINE_SIGNALS * LINE_BLOCK;  ///< where it begins
constexpr std::size_t INDICATOR_COUNT = LOADED_BLOCK + 3 * LOADED_COUNT;

constexpr std::size_t indexOf(ScalarIndicator indicator)
{
  return static_cast<std::size_t>(indicator);
}
constexpr std::size_t amplitudeIndex(LineSignal signal, std::size_t line)  ///< hasLine
{
  return line < FIRST_LOADED ? SCALAR_COUNT + static_cast<std::size_t>(signal) * LINE_BLOCK + line :
                               LOADED_BLOCK + line - FIRST_LOADED;
}
constexpr std::size_t cosineIndex(LineSignal signal, std::size_t line)  ///< hasLine, isPhaseLocked
{
  return line < FIRST_LOADED ? amplitudeIndex(signal, 0) + FIRST_LOADED + 2 * line :
                               LOADED_BLOCK + LOADED_COUNT + 2 * (line - FIRST_LOADED);
}
constexpr std::size_t sineIndex(LineSignal signal, std::size_t line)
{
  return cosineIndex(signal, line) + 1;
}

/// Whether it is the amplitude of a line whose phase is free.
constexpr bool isFreeAmplitude(std::size_t indicator)
{
  return indicator >= SCALAR_COUNT && indicator < LOADED_BLOCK &&
         (indicator - SCALAR_COUNT) % LINE_BLOCK >= FIRST_LOCKED &&
         (indicator - SCALAR_COUNT) % LINE_BLOCK < FIRST_LOADED;
}

/// Snake case, as in Indicators.msg: "torsional_stiffness", "error_wave_generator_2", "torque_wave_generator_2_cos".
/// Lives as long as the program.
const char* indicatorName(std::size_t indicator) noexcept;
const char* indicatorUnit(std::size_t indicator) noexcept;

/// How the joint was run during a window; means over it.
struct OperatingPoint
{
  double speed{};          ///< magnitude, motor [rad/s]
  double direction{};      ///< share of travel forward less share back: -1 ... 1 [-]
  double load{};           ///< magnitude of the load torque; NaN: no estimate of it [N.m]
  double temperature{};    ///< NaN: not measured [degC]
  double load_constant{};  ///< of the load torque, what does not depend on the output angle; NaN as load [N.m]
  double load_sine{};      ///< of the load torque over the sine of the output angle; NaN as load [N.m]
  double load_cosine{};    ///< and over its cosine; NaN as load [N.m]
  double inertia{};        ///< motor torque over the acceleration, the drive's own included, at the joint [kg.m^2]
};

/// All indicators of one window. NaN: the window did not tell.
struct SignalIndicators
{
  SignalIndicators() { values.fill(std::numeric_limits<double>::quiet_NaN()); }

  double operator[](ScalarIndicator indicator) const noexcept { return values[indexOf(indicator)]; }
  double amplitude(LineSignal signal, Line line) const noexcept { return values[amplitudeIndex(signal, index(line))]; }
  double phase(LineSignal signal, Line line) const noexcept;  ///< of a cosine, at motor angle 0; else NaN [rad]

  std::int64_t stamp{};     ///< end of the window [ns]
  std::uint64_t windows{};  ///< completed since start or reset, this one included; 0: none yet
  double turns{};           ///< of the motor at steady speed in the window [-]
  OperatingPoint point;
  std::array<double, INDICATOR_COUNT> values{};
  std::array<double, INDICATOR_COUNT> uncertainty{};  ///< standard error by the fit, 0: not known; units as values
};

/// `measured` minus the indicators of a model with the same inputs. The amplitude of a phase-locked line is that of the
/// complex difference of both lines, not the difference of both amplitudes.
SignalIndicators difference(const SignalIndicators& measured, const SignalIndicators& model) noexcept;
}  // namespace hjt
