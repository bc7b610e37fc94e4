// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/motion_driven.hpp"

#include <cmath>

#include "gear/ratio.hpp"

namespace hjt
{
MotionDriven::MotionDriven(const Parameters& parameters)
  : friction_(parameters)
  , presliding_(parameters.telemetry)
  , ripple_(parameters.telemetry, nominalRatio(parameters.gear))
  , load_(parameters.output)
  , telemetry_(parameters.telemetry)
  , inertia_(Motor(parameters.motor).inertia() - parameters.telemetry.inertia_in_load)
  , ratio_(nominalRatio(parameters.gear))
  , temperature_(parameters.input.temperature)
{
}

MotionPrediction MotionDriven::step(const MotionSample& sample) noexcept
{
  if (!started_ || sample.after_gap)
  {
    presliding_.reset();
    last_ = sample;
    started_ = true;
  }
  presliding_.move(ratio_ * (sample.position - last_.position), sample.time - last_.time);
  const double share = presliding_.share();
  last_ = sample;

  const double friction = friction_.at(ratio_ * sample.velocity, sample.load, temperature_).sum();
  MotionPrediction prediction;
  prediction.friction_limit = ratio_ * friction;
  prediction.friction_torque = share * prediction.friction_limit;
  prediction.motor_torque = sample.load / ratio_ + inertia_ * ratio_ * sample.acceleration + share * friction +
                            ripple_.at(sample.position, sample.velocity) / ratio_;
  prediction.current = ratio_ * prediction.motor_torque / telemetry_.torque_per_current + telemetry_.current_offset;
  prediction.band = (1.0 - std::abs(share)) * prediction.friction_limit / telemetry_.torque_per_current;
  return prediction;
}
}  // namespace hjt
