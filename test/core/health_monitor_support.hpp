// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "health/health_monitor.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "model/lobe_loads.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
constexpr std::int64_t STEP = 100000;  // [ns]
constexpr double RATIO = 101.0;

inline GearParameters gear()
{
  GearParameters gear;
  gear.teeth_flexspline = 200;
  gear.teeth_circular_spline = 202;
  return gear;
}

inline HealthParameters health()
{
  HealthParameters health;
  health.stiffness_torque_span = 10.0;
  health.averaging_time = 0.5;
  return health;
}

class Monitored : public testing::Test
{
protected:
  /// Turns the motor to `end` in steps of `step`, the output given as a function of the motor angle.
  void turnTo(double end, double step, const std::function<double(double)>& output)
  {
    const auto steps = static_cast<int>(std::ceil(std::abs(end - sample_.motor_angle) / step - 1e-9));
    const double start = sample_.motor_angle;
    for (int i = 1; i <= steps; ++i)
    {
      sample_.motor_angle = start + (end - start) * i / steps;
      sample_.output_angle = output(sample_.motor_angle);
      update();
    }
  }

  /// Lets the sample stand for a time [s], after `change` at every step with the time since the call [s].
  void run(double duration, const std::function<void(double, HealthSample&)>& change)
  {
    for (std::int64_t elapsed = 0; elapsed < std::llround(1e9 * duration); elapsed += STEP)
    {
      change(1e-9 * static_cast<double>(elapsed), sample_);
      update();
    }
  }

  void update()
  {
    monitor_.update(sample_);
    sample_.stamp += STEP;
  }

  MotionIndicators indicators() const { return monitor_.indicators(); }

  HealthMonitor monitor_{ health(), gear() };
  HealthSample sample_;
};
}  // namespace hjt
