// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/health/assessment.hpp"
#include "health/signal_monitor.hpp"
#include "params/variants.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Health of a measured joint from its own signals, live and offline alike. Nothing allocates or throws after
/// construction.
class SignalWatch
{
public:
  explicit SignalWatch(const Parameters& parameters)
    : telemetry_(parameters.telemetry)
    , ratio_(nominalRatio(parameters.gear))
    , temperature_(parameters.input.temperature)
    , monitor_(withoutWeight(parameters))  // the load of a sample holds the weight
    , assessor_(parameters)
  {
  }

  /// The reference to hold the joint against; none: it is learned from the first windows.
  void setReference(std::vector<ReferenceBin> bins) { assessor_.setReference(std::move(bins)); }

  /// `sample`: its load holds weight and inertia too. True: a window is complete, and what follows is of it.
  bool update(const MotionSample& sample) noexcept
  {
    SignalSample signal;
    signal.stamp = std::llround(1e9 * sample.time);
    signal.motor_angle = sample.motor_angle;
    signal.output_angle = sample.position;
    signal.motor_velocity = ratio_ * sample.velocity;
    signal.motor_torque = telemetry_.torque_per_current * (sample.current - telemetry_.current_offset) / ratio_;
    signal.load_torque = sample.load;
    signal.temperature = sample.temperatureOr(temperature_);
    if (!monitor_.update(signal))
    {
      return false;
    }
    assessor_.update(monitor_.indicators());
    return true;
  }

  void reset() noexcept
  {
    monitor_.reset();
    assessor_.reset();
  }

  const SignalIndicators& indicators() const noexcept { return monitor_.indicators(); }
  const Assessor& assessor() const noexcept { return assessor_; }

private:
  TelemetryParameters telemetry_;
  double ratio_;
  double temperature_;  // of samples without one [degC]
  SignalMonitor monitor_;
  Assessor assessor_;
};
}  // namespace hjt
