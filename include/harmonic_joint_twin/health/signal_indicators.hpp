// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Lines that the indicators contain, each with its cycles per turn of the motor (trackedOrders). A phase-locked line
/// (isPhaseLocked) depends on the angles of motor and output alone, so its phase is equal in all windows. The phase of
/// the other lines changes, because the balls slip.
///
/// A cracked tooth or rim yields only under load, in the direction of the load. The line by the crack changes sign with
/// the load and vanishes in the mean of a motion with loads of both signs. The part of a line in proportion to the load
/// is therefore a separate line, from FIRST_LOADED on, with its value at the rated torque. A part that lags behind its
/// cause also changes sign with the direction of motion, and is a third line.
enum class Line : std::size_t
{
  WAVE_GENERATOR_1,  ///< once per turn of the motor: an eccentric wave generator turns
  WAVE_GENERATOR_2,  ///< each lobe passes a place of the flexspline
  WAVE_GENERATOR_4,  ///< WAVE_GENERATOR_4, _6 and _8 are harmonics of WAVE_GENERATOR_2
  WAVE_GENERATOR_6,
  WAVE_GENERATOR_8,
  CIRCULAR_SPLINE_2,  ///< each lobe passes a place of the circular spline
  CAGE_LOBES,         ///< each lobe passes a place of the cage
  CAGE_LOBES_DOUBLE,
  BALL,             ///< a place on a ball meets one of the races
  BALL_BELOW,       ///< order of BALL minus that of CAGE_LOBES: sideband, because the lobes load the ball in turn
  BALL_FAR_BELOW,   ///< order of BALL minus twice that of CAGE_LOBES
  BALL_ABOVE,       ///< order of BALL plus that of CAGE_LOBES
  OUTER,            ///< balls roll over a place of the outer race
  OUTER_BELOW,      ///< order of OUTER minus 2: sideband, because the two lobes load the place in turn
  OUTER_FAR_BELOW,  ///< order of OUTER minus 4
  OUTER_ABOVE,      ///< order of OUTER plus 2
  INNER,            ///< balls roll over a place of the inner race, which turns with the lobes
  INNER_DOUBLE,
  WAVE_GENERATOR_4_LOAD,  ///< part of WAVE_GENERATOR_4 in proportion to the load
  WAVE_GENERATOR_6_LOAD,
  WAVE_GENERATOR_8_LOAD,
  WAVE_GENERATOR_4_LOAD_LAG,  ///< part of WAVE_GENERATOR_4 in proportion to the load times the sign of the speed
  WAVE_GENERATOR_6_LOAD_LAG,
  WAVE_GENERATOR_8_LOAD_LAG,
  COUNT
};
constexpr auto LINE_COUNT = static_cast<std::size_t>(Line::COUNT);
constexpr auto FIRST_LOADED = static_cast<std::size_t>(Line::WAVE_GENERATOR_4_LOAD);
constexpr std::size_t LOADED_ORDERS = 3;  ///< number of orders with lines in proportion to the load, from order 4 on
constexpr std::size_t LOADED_COUNT = 2 * LOADED_ORDERS;
constexpr std::size_t FIRST_LOCKED = 6;  ///< number of phase-locked lines that are not in proportion to the load
static_assert(FIRST_LOADED + LOADED_COUNT == LINE_COUNT);

constexpr bool isPhaseLocked(std::size_t line)
{
  return line < FIRST_LOCKED || line >= FIRST_LOADED;
}

constexpr std::size_t index(Line line)
{
  return static_cast<std::size_t>(line);
}

using LineOrders = std::array<double, LINE_COUNT>;  ///< cycles of each line per turn of the motor

/// Cycles of each line per turn of the motor.
///
/// Law:   cage   f_c = (1 - s) (1 - d / D) / 2           outer race at rest, inner race turning with the motor
///        outer  Z f_c,   inner  Z (1 - f_c),   ball  twice (1 - s) D / (2 d) (1 - (d / D)^2)
///        lobe at a place of the cage  2 (1 - f_c),   lobe at a place of the circular spline  2 (1 - 1 / i)
/// where  d, D, Z  ball diameter, pitch diameter [m], number of balls;  i  nominal ratio [-];  s  `slip` [-]
/// Source: rolling-bearing kinematics, contact angle 0 (e.g. Harris, Rolling Bearing Analysis, ch. 25).
LineOrders trackedOrders(const GearParameters& gear, const BearingParameters& bearing, double slip = 0.0);

/// Scalar indicators from encoders and torque alone. docs/indicators.md gives their formulas, their windows and the
/// faults that change them. The other indicators are, for each LineSignal, the amplitude of every line and the cosine
/// and sine parts of the phase-locked lines.
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

/// Signals in which the amplitudes of the lines are measured.
enum class LineSignal : std::size_t
{
  KINEMATIC_ERROR,
  MOTOR_TORQUE,
  MOTOR_RIPPLE  ///< ripple of the motor angle, to which the motor's controller is too slow to respond
};
inline constexpr std::array ALL_LINE_SIGNALS{ LineSignal::KINEMATIC_ERROR, LineSignal::MOTOR_TORQUE,
                                              LineSignal::MOTOR_RIPPLE };
constexpr std::size_t LINE_SIGNALS = ALL_LINE_SIGNALS.size();

/// Whether a line is an indicator of a signal. Lines in proportion to the load are indicators of the ripple alone,
/// because their amplitudes in torsion and current are smaller than the noise.
constexpr bool hasLine(LineSignal signal, std::size_t line)
{
  return line < FIRST_LOADED || signal == LineSignal::MOTOR_RIPPLE;
}

constexpr auto SCALAR_COUNT = static_cast<std::size_t>(ScalarIndicator::COUNT);
constexpr std::size_t LINE_BLOCK = FIRST_LOADED + 2 * FIRST_LOCKED;
/// index of the first indicator of the lines whose amplitude is proportional to the load
constexpr std::size_t LOADED_BLOCK = SCALAR_COUNT + LINE_SIGNALS * LINE_BLOCK;
constexpr std::size_t INDICATOR_COUNT = LOADED_BLOCK + 3 * LOADED_COUNT;

constexpr std::size_t indexOf(ScalarIndicator indicator)
{
  return static_cast<std::size_t>(indicator);
}
constexpr std::size_t amplitudeIndex(LineSignal signal, std::size_t line)  ///< index of the amplitude; needs hasLine
{
  return line < FIRST_LOADED ? SCALAR_COUNT + static_cast<std::size_t>(signal) * LINE_BLOCK + line :
                               LOADED_BLOCK + line - FIRST_LOADED;
}
constexpr std::size_t cosineIndex(LineSignal signal, std::size_t line)  ///< index; needs hasLine and isPhaseLocked
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

/// Motion, load and temperature of the joint, as means over a window.
struct OperatingPoint
{
  double speed{};          ///< magnitude of the motor's speed [rad/s]
  double direction{};      ///< share of the travel forward minus the share of the travel back: -1 ... 1 [-]
  double load{};           ///< magnitude of the load torque; NaN: not known [N.m]
  double temperature{};    ///< temperature of the drive; NaN: not measured [degC]
  double load_constant{};  ///< part of the load torque that does not depend on the output angle; NaN: not known [N.m]
  double load_sine{};      ///< factor of sin(output angle) in the load torque; NaN: load not known [N.m]
  double load_cosine{};    ///< factor of cos(output angle) in the load torque; NaN: load not known [N.m]
  double inertia{};        ///< inertia of drive and load at the joint, estimated from the motor torque [kg.m^2]
};

/// All indicators of one window. NaN: the window did not determine the indicator.
struct SignalIndicators
{
  SignalIndicators() { values.fill(std::numeric_limits<double>::quiet_NaN()); }

  double operator[](ScalarIndicator indicator) const noexcept { return values[indexOf(indicator)]; }
  double amplitude(LineSignal signal, Line line) const noexcept { return values[amplitudeIndex(signal, index(line))]; }
  double phase(LineSignal signal, Line line) const noexcept;  ///< phase, NaN if not phase-locked [rad]

  std::int64_t stamp{};     ///< end of the window [ns]
  std::uint64_t windows{};  ///< number of windows completed since start or reset, including this window; 0: none
  double turns{};           ///< turns of the motor at constant speed in the window [-]
  OperatingPoint point;
  std::array<double, INDICATOR_COUNT> values{};
  /// standard error of each value by the fit of the lines, in the unit of the value; 0: not known
  std::array<double, INDICATOR_COUNT> uncertainty{};
};

/// Indicators `measured` minus the indicators `model` of a twin with the same inputs. The amplitude of a phase-locked
/// line is the amplitude of the complex difference of the two lines, not the difference of their amplitudes.
SignalIndicators difference(const SignalIndicators& measured, const SignalIndicators& model) noexcept;
}  // namespace hjt
