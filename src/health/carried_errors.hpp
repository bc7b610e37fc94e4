// SPDX-License-Identifier: BSD-3-Clause
// Written by `scripts/evaluate_health --fit`.
#pragma once

#include <array>
#include <cstddef>

#include "harmonic_joint_twin/health/signal_indicators.hpp"

namespace hjt
{
/// What the indicators of a sound drive, less a model's, differ by from one motion to another.
struct CarriedError
{
  double deviation{ 1e30 };  ///< rms of a drive like the model, unit of the indicator; 1e30: not known
  double share{};            ///< of what drive and model differ by, of a line all of its signal [-]
  double freedom{ 1.0 };     ///< degrees of freedom both are known with [-]
};

struct CarriedRow
{
  std::size_t indicator;
  CarriedError error;
};

// clang-format off
inline constexpr CarriedRow CARRIED_ROWS[] = {
{ indexOf(ScalarIndicator::RATIO_DEVIATION), { 8.49e-05, 0.18, 43.4 } },
{ indexOf(ScalarIndicator::KINEMATIC_ERROR), { 2.18e-08, 0.259, 60.0 } },
{ indexOf(ScalarIndicator::TORSIONAL_STIFFNESS), { 0.472, 0.152, 60.0 } },
{ indexOf(ScalarIndicator::SECOND_STIFFNESS), { 282, 0.228, 60.0 } },
{ indexOf(ScalarIndicator::LOST_MOTION), { 1.96e-07, 0.295, 60.0 } },
{ indexOf(ScalarIndicator::HYSTERESIS_AREA), { 0.000682, 0.496, 60.0 } },
{ indexOf(ScalarIndicator::RUNNING_TORQUE), { 0.00123, 0.175, 59.8 } },
{ indexOf(ScalarIndicator::COULOMB_TORQUE), { 0.000701, 0.164, 10.0 } },
{ indexOf(ScalarIndicator::VISCOUS_FRICTION), { 2.57e-05, 0, 10.0 } },
{ indexOf(ScalarIndicator::EFFICIENCY), { 1e+30, 0, 1.0 } },
{ indexOf(ScalarIndicator::RESIDUAL_RMS), { 1e+30, 0, 1.0 } },
{ indexOf(ScalarIndicator::RESIDUAL_KURTOSIS), { 1e+30, 0, 1.0 } },
{ indexOf(ScalarIndicator::RESIDUAL_CREST), { 1e+30, 0, 1.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_1)), { 1.17e-06, 0, 59.5 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_2)), { 2.46e-07, 1.67, 30.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_4)), { 2.29e-07, 0.175, 39.7 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_6)), { 1.95e-07, 0.0594, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_8)), { 1.87e-07, 0.057, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::CIRCULAR_SPLINE_2)), { 3.37e-07, 1.45, 30.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::CAGE_LOBES)), { 1.29e-07, 0.0175, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::CAGE_LOBES_DOUBLE)), { 1.05e-07, 0.113, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::BALL)), { 1.15e-07, 0, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::BALL_BELOW)), { 1.11e-07, 0, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::BALL_FAR_BELOW)), { 1.25e-07, 0.0019, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::BALL_ABOVE)), { 1.07e-07, 0, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::OUTER)), { 1.22e-07, 0, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::OUTER_BELOW)), { 1.16e-07, 0.00157, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::OUTER_FAR_BELOW)), { 1.15e-07, 0.00311, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::OUTER_ABOVE)), { 1.13e-07, 0.000866, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::INNER)), { 1.07e-07, 0.0013, 60.0 } },
{ amplitudeIndex(LineSignal::KINEMATIC_ERROR, index(Line::INNER_DOUBLE)), { 1.17e-07, 0, 60.0 } },
{ cosineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_1)), { 6.21e-07, 0.00844, 60.0 } },
{ sineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_1)), { 1.34e-06, 0, 47.5 } },
{ cosineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_2)), { 1.74e-08, 1.06, 17.1 } },
{ sineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_2)), { 2.34e-08, 1.42, 18.5 } },
{ cosineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_4)), { 1.06e-07, 0.129, 33.8 } },
{ sineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_4)), { 1.18e-07, 0.143, 27.2 } },
{ cosineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_6)), { 1.04e-07, 0.0711, 60.0 } },
{ sineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_6)), { 1.02e-07, 0.0619, 31.6 } },
{ cosineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_8)), { 1.02e-07, 0.0389, 60.0 } },
{ sineIndex(LineSignal::KINEMATIC_ERROR, index(Line::WAVE_GENERATOR_8)), { 8.08e-08, 0.0618, 60.0 } },
{ cosineIndex(LineSignal::KINEMATIC_ERROR, index(Line::CIRCULAR_SPLINE_2)), { 2.01e-08, 1.22, 30.0 } },
{ sineIndex(LineSignal::KINEMATIC_ERROR, index(Line::CIRCULAR_SPLINE_2)), { 2.26e-08, 1.37, 27.3 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_1)), { 0.000274, 0.0802, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_2)), { 8.04e-06, 3.33, 24.7 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_4)), { 9.36e-05, 0.434, 40.1 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_6)), { 0.000149, 0.0872, 51.1 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_8)), { 0.000132, 0.0867, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::CIRCULAR_SPLINE_2)), { 7.31e-06, 3.02, 30.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::CAGE_LOBES)), { 0.000126, 0.0415, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::CAGE_LOBES_DOUBLE)), { 2.97e-05, 0.275, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::BALL)), { 0.000112, 0, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::BALL_BELOW)), { 0.000111, 0.00145, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::BALL_FAR_BELOW)), { 0.000113, 0, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::BALL_ABOVE)), { 0.000109, 0, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::OUTER)), { 0.000125, 0, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::OUTER_BELOW)), { 0.000107, 0, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::OUTER_FAR_BELOW)), { 0.000115, 0, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::OUTER_ABOVE)), { 0.000121, 0.00251, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::INNER)), { 0.000102, 0.00376, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::INNER_DOUBLE)), { 0.000114, 0, 60.0 } },
{ cosineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_1)), { 0.000256, 0.00595, 60.0 } },
{ sineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_1)), { 0.000412, 0.0136, 60.0 } },
{ cosineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_2)), { 5.02e-06, 2.08, 15.3 } },
{ sineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_2)), { 6.79e-06, 2.81, 17.0 } },
{ cosineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_4)), { 6.91e-07, 0.286, 29.3 } },
{ sineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_4)), { 8.46e-07, 0.35, 21.6 } },
{ cosineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_6)), { 7.94e-05, 0.131, 60.0 } },
{ sineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_6)), { 7.86e-05, 0.129, 46.5 } },
{ cosineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_8)), { 9.88e-05, 0.0816, 60.0 } },
{ sineIndex(LineSignal::MOTOR_TORQUE, index(Line::WAVE_GENERATOR_8)), { 5.91e-05, 0.123, 60.0 } },
{ cosineIndex(LineSignal::MOTOR_TORQUE, index(Line::CIRCULAR_SPLINE_2)), { 5.24e-06, 2.17, 26.3 } },
{ sineIndex(LineSignal::MOTOR_TORQUE, index(Line::CIRCULAR_SPLINE_2)), { 6.38e-06, 2.64, 26.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_1)), { 9.02e-05, 0.0426, 54.1 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_2)), { 2e-06, 8.4, 15.4 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4)), { 1.13e-05, 0.952, 17.6 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6)), { 7.33e-06, 0.275, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8)), { 6.77e-06, 0.202, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::CIRCULAR_SPLINE_2)), { 2.45e-06, 10.3, 13.2 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::CAGE_LOBES)), { 2.16e-05, 0.0511, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::CAGE_LOBES_DOUBLE)), { 3.45e-06, 0.577, 51.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::BALL)), { 3.53e-06, 0.0132, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::BALL_BELOW)), { 4.68e-06, 0.00784, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::BALL_FAR_BELOW)), { 2.35e-06, 0.0623, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::BALL_ABOVE)), { 4.22e-06, 0.00707, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::OUTER)), { 3.39e-06, 0.016, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::OUTER_BELOW)), { 2.83e-06, 0.067, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::OUTER_FAR_BELOW)), { 2.25e-06, 0.0189, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::OUTER_ABOVE)), { 4.35e-06, 0.0046, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::INNER)), { 4.5e-06, 0.00475, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::INNER_DOUBLE)), { 6.56e-06, 0.00618, 58.1 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_1)), { 0.000101, 0.0337, 47.1 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_1)), { 5.98e-05, 0.0447, 54.7 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_2)), { 1.49e-06, 6.26, 6.3 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_2)), { 1.36e-06, 5.71, 17.9 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4)), { 1.97e-07, 0.827, 14.5 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4)), { 9.52e-07, 0.635, 19.3 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6)), { 2.03e-06, 0.302, 60.0 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6)), { 2.72e-06, 0.287, 30.0 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8)), { 3.04e-06, 0.161, 57.8 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8)), { 2.88e-06, 0.192, 57.8 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::CIRCULAR_SPLINE_2)), { 1.85e-06, 7.78, 6.4 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::CIRCULAR_SPLINE_2)), { 1.72e-06, 7.23, 18.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4_LOAD)), { 0.000302, 8.01, 14.2 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6_LOAD)), { 8.71e-05, 0.731, 27.9 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8_LOAD)), { 6.44e-05, 0.961, 60.0 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4_LOAD_LAG)), { 4.73e-05, 3.16, 26.9 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6_LOAD_LAG)), { 0.000113, 2.67, 13.8 } },
{ amplitudeIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8_LOAD_LAG)), { 5.19e-05, 1.38, 40.0 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4_LOAD)), { 9.14e-05, 5.43, 8.3 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4_LOAD)), { 9.4e-05, 5.59, 11.6 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6_LOAD)), { 2.3e-05, 0.611, 34.5 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6_LOAD)), { 2.08e-05, 0.78, 20.2 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8_LOAD)), { 1.54e-05, 1.02, 60.0 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8_LOAD)), { 1.94e-05, 0.727, 60.0 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4_LOAD_LAG)), { 7.69e-06, 2.29, 12.1 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_4_LOAD_LAG)), { 6.42e-06, 2.41, 12.9 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6_LOAD_LAG)), { 2.79e-05, 1.66, 12.5 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_6_LOAD_LAG)), { 2.62e-05, 2.47, 8.7 } },
{ cosineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8_LOAD_LAG)), { 1.49e-05, 1.25, 38.7 } },
{ sineIndex(LineSignal::MOTOR_RIPPLE, index(Line::WAVE_GENERATOR_8_LOAD_LAG)), { 1.64e-05, 1.38, 40.0 } },
};
// clang-format on

/// By indicator; without a row it is not known.
inline constexpr std::array<CarriedError, INDICATOR_COUNT> CARRIED_ERRORS = []
{
  std::array<CarriedError, INDICATOR_COUNT> errors{};
  for (const CarriedRow& row : CARRIED_ROWS)
  {
    errors[row.indicator] = row.error;
  }
  return errors;
}();
}  // namespace hjt
