// SPDX-License-Identifier: BSD-3-Clause
// Written by `scripts/evaluate_health --fit`.
#pragma once

#include <iterator>

#include "harmonic_joint_twin/health/signal_indicators.hpp"

namespace hjt
{
/// What the indicators of a sound drive, less a model's, differ by from one motion to another.
struct CarriedError
{
  double deviation;  ///< rms of a drive like the model, unit of the indicator; 1e30: not known
  double share;      ///< of what the drive differs from the model by, of a line all of its signal [-]
  double freedom;    ///< degrees of freedom both are known with [-]
};

// clang-format off
inline constexpr CarriedError CARRIED_ERRORS[] = {
{ 8.49e-05, 0.18, 43.4 },  // ratio_deviation
{ 2.18e-08, 0.259, 60.0 },  // kinematic_error
{ 0.472, 0.152, 60.0 },  // torsional_stiffness
{ 282, 0.228, 60.0 },  // second_stiffness
{ 1.96e-07, 0.295, 60.0 },  // lost_motion
{ 0.000682, 0.496, 60.0 },  // hysteresis_area
{ 0.00123, 0.175, 59.8 },  // running_torque
{ 0.000701, 0.164, 10.0 },  // coulomb_torque
{ 2.57e-05, 0, 10.0 },  // viscous_friction
{ 1e+30, 0, 1.0 },  // efficiency
{ 1e+30, 0, 1.0 },  // residual_rms
{ 1e+30, 0, 1.0 },  // residual_kurtosis
{ 1e+30, 0, 1.0 },  // residual_crest
{ 1.17e-06, 0, 59.5 },  // error_wave_generator_1
{ 2.46e-07, 1.67, 30.0 },  // error_wave_generator_2
{ 2.29e-07, 0.175, 39.7 },  // error_wave_generator_4
{ 1.95e-07, 0.0594, 60.0 },  // error_wave_generator_6
{ 1.87e-07, 0.057, 60.0 },  // error_wave_generator_8
{ 3.37e-07, 1.45, 30.0 },  // error_circular_spline_2
{ 1.29e-07, 0.0175, 60.0 },  // error_cage_lobes
{ 1.05e-07, 0.113, 60.0 },  // error_cage_lobes_double
{ 1.15e-07, 0, 60.0 },  // error_ball
{ 1.11e-07, 0, 60.0 },  // error_ball_below
{ 1.25e-07, 0.0019, 60.0 },  // error_ball_far_below
{ 1.07e-07, 0, 60.0 },  // error_ball_above
{ 1.22e-07, 0, 60.0 },  // error_outer
{ 1.16e-07, 0.00157, 60.0 },  // error_outer_below
{ 1.15e-07, 0.00311, 60.0 },  // error_outer_far_below
{ 1.13e-07, 0.000866, 60.0 },  // error_outer_above
{ 1.07e-07, 0.0013, 60.0 },  // error_inner
{ 1.17e-07, 0, 60.0 },  // error_inner_double
{ 6.21e-07, 0.00844, 60.0 },  // error_wave_generator_1_cos
{ 1.34e-06, 0, 47.5 },  // error_wave_generator_1_sin
{ 1.74e-08, 1.06, 17.1 },  // error_wave_generator_2_cos
{ 2.34e-08, 1.42, 18.5 },  // error_wave_generator_2_sin
{ 1.06e-07, 0.129, 33.8 },  // error_wave_generator_4_cos
{ 1.18e-07, 0.143, 27.2 },  // error_wave_generator_4_sin
{ 1.04e-07, 0.0711, 60.0 },  // error_wave_generator_6_cos
{ 1.02e-07, 0.0619, 31.6 },  // error_wave_generator_6_sin
{ 1.02e-07, 0.0389, 60.0 },  // error_wave_generator_8_cos
{ 8.08e-08, 0.0618, 60.0 },  // error_wave_generator_8_sin
{ 2.01e-08, 1.22, 30.0 },  // error_circular_spline_2_cos
{ 2.26e-08, 1.37, 27.3 },  // error_circular_spline_2_sin
{ 0.000274, 0.0802, 60.0 },  // torque_wave_generator_1
{ 8.04e-06, 3.33, 24.7 },  // torque_wave_generator_2
{ 9.36e-05, 0.434, 40.1 },  // torque_wave_generator_4
{ 0.000149, 0.0872, 51.1 },  // torque_wave_generator_6
{ 0.000132, 0.0867, 60.0 },  // torque_wave_generator_8
{ 7.31e-06, 3.02, 30.0 },  // torque_circular_spline_2
{ 0.000126, 0.0415, 60.0 },  // torque_cage_lobes
{ 2.97e-05, 0.275, 60.0 },  // torque_cage_lobes_double
{ 0.000112, 0, 60.0 },  // torque_ball
{ 0.000111, 0.00145, 60.0 },  // torque_ball_below
{ 0.000113, 0, 60.0 },  // torque_ball_far_below
{ 0.000109, 0, 60.0 },  // torque_ball_above
{ 0.000125, 0, 60.0 },  // torque_outer
{ 0.000107, 0, 60.0 },  // torque_outer_below
{ 0.000115, 0, 60.0 },  // torque_outer_far_below
{ 0.000121, 0.00251, 60.0 },  // torque_outer_above
{ 0.000102, 0.00376, 60.0 },  // torque_inner
{ 0.000114, 0, 60.0 },  // torque_inner_double
{ 0.000256, 0.00595, 60.0 },  // torque_wave_generator_1_cos
{ 0.000412, 0.0136, 60.0 },  // torque_wave_generator_1_sin
{ 5.02e-06, 2.08, 15.3 },  // torque_wave_generator_2_cos
{ 6.79e-06, 2.81, 17.0 },  // torque_wave_generator_2_sin
{ 6.91e-07, 0.286, 29.3 },  // torque_wave_generator_4_cos
{ 8.46e-07, 0.35, 21.6 },  // torque_wave_generator_4_sin
{ 7.94e-05, 0.131, 60.0 },  // torque_wave_generator_6_cos
{ 7.86e-05, 0.129, 46.5 },  // torque_wave_generator_6_sin
{ 9.88e-05, 0.0816, 60.0 },  // torque_wave_generator_8_cos
{ 5.91e-05, 0.123, 60.0 },  // torque_wave_generator_8_sin
{ 5.24e-06, 2.17, 26.3 },  // torque_circular_spline_2_cos
{ 6.38e-06, 2.64, 26.0 },  // torque_circular_spline_2_sin
{ 9.02e-05, 0.0426, 54.1 },  // ripple_wave_generator_1
{ 2e-06, 8.4, 15.4 },  // ripple_wave_generator_2
{ 1.13e-05, 0.952, 17.6 },  // ripple_wave_generator_4
{ 7.33e-06, 0.275, 60.0 },  // ripple_wave_generator_6
{ 6.77e-06, 0.202, 60.0 },  // ripple_wave_generator_8
{ 2.45e-06, 10.3, 13.2 },  // ripple_circular_spline_2
{ 2.16e-05, 0.0511, 60.0 },  // ripple_cage_lobes
{ 3.45e-06, 0.577, 51.0 },  // ripple_cage_lobes_double
{ 3.53e-06, 0.0132, 60.0 },  // ripple_ball
{ 4.68e-06, 0.00784, 60.0 },  // ripple_ball_below
{ 2.35e-06, 0.0623, 60.0 },  // ripple_ball_far_below
{ 4.22e-06, 0.00707, 60.0 },  // ripple_ball_above
{ 3.39e-06, 0.016, 60.0 },  // ripple_outer
{ 2.83e-06, 0.067, 60.0 },  // ripple_outer_below
{ 2.25e-06, 0.0189, 60.0 },  // ripple_outer_far_below
{ 4.35e-06, 0.0046, 60.0 },  // ripple_outer_above
{ 4.5e-06, 0.00475, 60.0 },  // ripple_inner
{ 6.56e-06, 0.00618, 58.1 },  // ripple_inner_double
{ 0.000101, 0.0337, 47.1 },  // ripple_wave_generator_1_cos
{ 5.98e-05, 0.0447, 54.7 },  // ripple_wave_generator_1_sin
{ 1.49e-06, 6.26, 6.3 },  // ripple_wave_generator_2_cos
{ 1.36e-06, 5.71, 17.9 },  // ripple_wave_generator_2_sin
{ 1.97e-07, 0.827, 14.5 },  // ripple_wave_generator_4_cos
{ 9.52e-07, 0.635, 19.3 },  // ripple_wave_generator_4_sin
{ 2.03e-06, 0.302, 60.0 },  // ripple_wave_generator_6_cos
{ 2.72e-06, 0.287, 30.0 },  // ripple_wave_generator_6_sin
{ 3.04e-06, 0.161, 57.8 },  // ripple_wave_generator_8_cos
{ 2.88e-06, 0.192, 57.8 },  // ripple_wave_generator_8_sin
{ 1.85e-06, 7.78, 6.4 },  // ripple_circular_spline_2_cos
{ 1.72e-06, 7.23, 18.0 },  // ripple_circular_spline_2_sin
{ 0.000302, 8.01, 14.2 },  // ripple_wave_generator_4_load
{ 8.71e-05, 0.731, 27.9 },  // ripple_wave_generator_6_load
{ 6.44e-05, 0.961, 60.0 },  // ripple_wave_generator_8_load
{ 4.73e-05, 3.16, 26.9 },  // ripple_wave_generator_4_load_lag
{ 0.000113, 2.67, 13.8 },  // ripple_wave_generator_6_load_lag
{ 5.19e-05, 1.38, 40.0 },  // ripple_wave_generator_8_load_lag
{ 9.14e-05, 5.43, 8.3 },  // ripple_wave_generator_4_load_cos
{ 9.4e-05, 5.59, 11.6 },  // ripple_wave_generator_4_load_sin
{ 2.3e-05, 0.611, 34.5 },  // ripple_wave_generator_6_load_cos
{ 2.08e-05, 0.78, 20.2 },  // ripple_wave_generator_6_load_sin
{ 1.54e-05, 1.02, 60.0 },  // ripple_wave_generator_8_load_cos
{ 1.94e-05, 0.727, 60.0 },  // ripple_wave_generator_8_load_sin
{ 7.69e-06, 2.29, 12.1 },  // ripple_wave_generator_4_load_lag_cos
{ 6.42e-06, 2.41, 12.9 },  // ripple_wave_generator_4_load_lag_sin
{ 2.79e-05, 1.66, 12.5 },  // ripple_wave_generator_6_load_lag_cos
{ 2.62e-05, 2.47, 8.7 },  // ripple_wave_generator_6_load_lag_sin
{ 1.49e-05, 1.25, 38.7 },  // ripple_wave_generator_8_load_lag_cos
{ 1.64e-05, 1.38, 40.0 },  // ripple_wave_generator_8_load_lag_sin
};
// clang-format on
static_assert(std::size(CARRIED_ERRORS) == INDICATOR_COUNT, "an indicator without an error");
}  // namespace hjt
