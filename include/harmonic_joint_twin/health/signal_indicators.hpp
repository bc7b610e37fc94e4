// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

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
