// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/efficiency_estimate.hpp"
#include "health/friction_estimate.hpp"
#include "health/lag_estimate.hpp"
#include "health/load_over_angle.hpp"
#include "health/order_tracker.hpp"
#include "health/ripple_filter.hpp"
#include "health/signal_sample.hpp"
#include "health/smoothed_torsion.hpp"
#include "health/torque_balance.hpp"
#include "health/torsion_loop_estimate.hpp"
#include "health/turn_window.hpp"

namespace hjt
{
/// Health indicators from a drive's own signals, window by window, in fixed memory. Allocates only at construction.
///
/// A window ends after indicators.window_turns turns of the motor at steady speed, either way, or after
/// indicators.window_time. The joint torque is the load estimate and the weight that output.gravity_torque says.
/// Steady: the mean speed over about half a turn is above indicators.least_speed, and the speed itself within
/// indicators.speed_change of it. Lines are fitted to the calm part of the steady motion: not from 20 ms before to
/// 0.4 s after a change of speed, which excites the drive a thousand times more than the lines. Without a motor encoder
/// they are fitted to all steady motion.
class SignalMonitor
{
public:
  explicit SignalMonitor(const Parameters& parameters);

  void reset() noexcept;

  /// True: this sample completed a window. A sample without stamp progress, angle or torque is passed over and counted.
  bool update(const SignalSample& given) noexcept;

  /// Of the last window that was completed.
  const SignalIndicators& indicators() const noexcept { return indicators_; }

  std::uint64_t refused() const noexcept { return refused_; }
  double progress() const noexcept;  ///< of the running window, 0 ... 1 [-]

private:
  /// Sums over a window; the mean is over `weight`.
  struct Mean
  {
    void add(double value, double value_weight = 1.0) noexcept
    {
      sum += value_weight * value;
      weight += value_weight;
    }
    double value() const noexcept { return sum / weight; }  // NaN: nothing came
    double sum{};
    double weight{};
  };

  struct Window
  {
    std::int64_t elapsed{};  // [ns]
    double travel{};         // at steady speed [rad]
    int samples{};           // at steady speed
    double line_travel{};    // of the samples that lines are fitted to [rad]
    int line_samples{};
    bool motor_encoder{ true };
    bool both_encoders{ true };
    Mean speed;
    Mean direction;
    Mean load;
    LoadOverAngle load_over_angle;
    Mean temperature;
    Mean running_torque;
    Mean ratio;
    Mean kinematic_error;
    double residuals{};  // number
    double residual_square{};
    double residual_fourth{};
    double residual_largest{};
  };

  /// A sample for the lines that waits whether the motion stays calm.
  struct Waiting
  {
    LineSample sample;
    double travel{};       // [rad]
    std::int64_t stamp{};  // [ns]
  };

  void start(const SignalSample& sample, double motor_angle) noexcept;
  double weightAt(double output_angle) const noexcept;
  SignalSample withWeight(SignalSample sample) const noexcept;
  void addLoop(const SignalSample& sample, double motor_angle, double torsion, double velocity,
               double seconds) noexcept;
  void addAny(const SignalSample& sample, double velocity, double motor_angle, double output_angle,
              double seconds) noexcept;
  bool judgeMotion(double velocity, double seconds, bool motor_known) noexcept;
  void addSteady(const SignalSample& sample, double motor_angle, double output_angle, double travel,
                 double torsion) noexcept;
  void addLines(const LineSample& sample, double travel, std::int64_t stamp) noexcept;
  void addTurn(double motor_angle, double travel, double torsion) noexcept;
  void addResidual(double travel) noexcept;
  void complete(std::int64_t stamp) noexcept;
  void fillLines(LineSignal signal) noexcept;
  void set(ScalarIndicator indicator, double value) noexcept { indicators_.values[indexOf(indicator)] = value; }
  void set(ScalarIndicator indicator, const Indicator& value) noexcept;
  void fillTorsion() noexcept;

  const double ratio_;
  const OutputParameters output_;
  const double output_inertia_;  // of the load and the circular spline [kg.m^2]
  const double motor_inertia_;   // of the motor and the wave generator, at the output [kg.m^2]
  const IndicatorParameters parameters_;
  OrderTracker tracker_;
  FrictionEstimate friction_;
  SmoothedTorsion smoothed_;
  TorsionLoopEstimate loop_;
  TurnWindow turn_;
  EfficiencyEstimate efficiency_;
  SignalIndicators indicators_;
  std::uint64_t refused_{};

  bool started_{};
  SignalSample last_;
  double last_angle_{};     // of the motor [rad]
  double torsion_zero_{};   // of the first sample, so that what is summed is small [rad]
  double mean_velocity_{};  // over about half a turn [rad/s]
  RippleFilter speed_;      // of the speed as read: uneven stamps do not disturb it
  RippleFilter angle_;      // of the motor angle
  TorqueBalance balance_;
  LagEstimate lag_;
  double calm_{};  // how long the motion has been [s]
  std::array<Waiting, 128> waiting_;
  std::size_t first_waiting_{};
  std::size_t waiting_count_{};
  double ringing_{};        // amplitude after the last change of speed [rad]
  double turn_travel_{};    // since the turn window was read [rad]
  bool tracked_{};          // every line has been fitted: the residual means something
  double residual_mean_{};  // slow [rad]
  Window window_;
};
}  // namespace hjt
