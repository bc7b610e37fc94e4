// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "health/signal_monitor.hpp"

#include <cmath>
#include <functional>
#include <memory>

#include <gmock/gmock.h>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/health/assessment.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "health/order_tracker.hpp"
#include "health/signature_file.hpp"
#include "sensors/joint_sensors.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
constexpr double ARCSEC = TWO_PI / 360.0 / 3600.0;
constexpr double RATIO = 101.0;

inline std::shared_ptr<const SignatureSet> shippedSignatures()
{
  return loadSignatures(shippedParameters().indicators.signatures);
}
constexpr std::int64_t SAMPLE = 500000;  // [ns]

/// A joint that moves as told, with a known error of motion and a known torque, read through the twin's encoders.
class Synthetic
{
public:
  explicit Synthetic(const Parameters& parameters)
    : orders(trackedOrders(parameters.gear, parameters.bearing))
    , monitor(parameters)
    , motor_encoder_(parameters.sensors)
    , output_encoder_(parameters.sensors)
  {
  }

  std::function<double(double)> speed = [](double) { return 100.0; };                 // of time [rad/s]
  std::function<double(double)> load = [](double) { return 0.0; };                    // of time [N.m]
  std::function<double(double, double)> error = [](double, double) { return 0.0; };   // motor angle, load [rad]
  std::function<double(double, double)> torque = [](double, double) { return 0.1; };  // motor angle, speed [N.m]
  // Of the motor: of its angle, the load and the time [rad]
  std::function<double(double, double, double)> ripple = [](double, double, double) { return 0.0; };
  bool quantised = true;

  /// One sample; true if it completed a window.
  bool step()
  {
    time_ += 1e-9 * SAMPLE;
    const double now = speed(time_);
    motor_angle_ += now * 1e-9 * SAMPLE;
    const double load_torque = load(time_);
    const double output_angle = motor_angle_ / RATIO - error(motor_angle_, load_torque);
    SignalSample sample;
    sample.stamp = stamp_ += SAMPLE;
    const double motor_angle = motor_angle_ + ripple(motor_angle_, load_torque, time_);
    sample.motor_angle = quantised ? motor_encoder_.angle(motor_encoder_.count(motor_angle)) : motor_angle;
    sample.output_angle = quantised ? output_encoder_.unwrappedAngle(output_angle) : output_angle;
    sample.motor_velocity = now;
    sample.motor_torque = torque(motor_angle_, now);
    sample.load_torque = load_torque;
    return monitor.update(sample);
  }

  const SignalIndicators& nextWindow()
  {
    while (!step())
    {
    }
    return monitor.indicators();
  }

  double line(Line which, double amplitude, double phase, double angle) const
  {
    return amplitude * std::cos(orders[index(which)] * angle + phase);
  }

  const LineOrders orders;
  SignalMonitor monitor;

private:
  IncrementalEncoder motor_encoder_;
  AbsoluteEncoder output_encoder_;
  double time_{};
  double motor_angle_{};
  std::int64_t stamp_{};
};

inline double& valueOf(SignalIndicators& window, ScalarIndicator indicator)
{
  return window.values[indexOf(indicator)];
}

/// A window in which nothing but the running torque [N.m] is known.
inline SignalIndicators torqueWindow(const OperatingPoint& point, double torque)
{
  SignalIndicators window;
  window.point = point;
  valueOf(window, ScalarIndicator::RUNNING_TORQUE) = torque;
  return window;
}

/// First window of samples that `fill` makes, by their number from 1 on.
template <class Fill>
SignalIndicators windowOfSamples(const std::vector<std::string>& assignments, const Fill& fill)
{
  SignalMonitor monitor(shippedParameters(assignments));
  SignalSample sample;
  int number = 0;
  do
  {
    fill(++number, sample);
  } while (!monitor.update(sample));
  return monitor.indicators();
}

/// A joint that swings about its zero at `rate` [rad/s], a weight and an inertia on it; with `friction` [N.m] at its
/// motor.
inline OperatingPoint swing(double rate, double friction = 0.0, bool load_known = true)
{
  constexpr double INERTIA = 3.5;
  constexpr double PEAK = 150.0;  // motor [rad/s]
  Synthetic joint(shippedParameters({ "indicators.window_turns=1e5", "indicators.window_time=20.0" }));
  double now = 0.0;
  joint.speed = [&](double time)
  {
    now = time;
    return PEAK * std::cos(rate * time);
  };
  const auto load = [rate](double time)
  {
    const double angle = PEAK / rate * std::sin(rate * time) / RATIO;
    return 4.0 + 30.0 * std::sin(angle) - 20.0 * std::cos(angle);
  };
  joint.load = [&](double time) { return load_known ? load(time) : std::nan(""); };
  joint.torque = [&](double /*angle*/, double speed) {
    return (load(now) - INERTIA * PEAK * rate * std::sin(rate * now) / RATIO) / RATIO + std::copysign(friction, speed);
  };
  return joint.nextWindow().point;
}

/// A joint whose order-2 line and noise are healthy until told otherwise.
inline const int LEARNING = shippedParameters().indicators.baseline_windows;
}  // namespace hjt
