// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/signal_watch.hpp"

#include <cmath>

#include "gear/ratio.hpp"
#include "params/variants.hpp"

namespace hjt
{
SignalWatch::SignalWatch(const Parameters& parameters)
  : telemetry_(parameters.telemetry)
  , ratio_(nominalRatio(parameters.gear))
  , temperature_(parameters.input.temperature)
  , monitor_(withoutWeight(parameters))  // the load of a sample holds the weight
  , assessor_(parameters)
{
}

bool SignalWatch::update(const MotionSample& sample) noexcept
{
  SignalSample signal;
  signal.stamp = std::llround(1e9 * sample.time);
  signal.motor_angle = sample.motor_angle;
  signal.output_angle = sample.position;
  signal.motor_velocity = ratio_ * sample.velocity;
  signal.motor_torque = telemetry_.torque_per_current * (sample.current - telemetry_.current_offset) / ratio_;
  signal.load_torque = sample.load;
  signal.temperature = temperature_;
  if (!monitor_.update(signal))
  {
    return false;
  }
  assessor_.update(monitor_.indicators());
  return true;
}

void SignalWatch::reset() noexcept
{
  monitor_.reset();
  assessor_.reset();
}
}  // namespace hjt
