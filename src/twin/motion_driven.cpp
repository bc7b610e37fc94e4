// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/motion_driven.hpp"

#include <cmath>

#include "harmonic_joint_twin/gear/ratio.hpp"

namespace hjt
{
double Presliding::move(double motor_step, double duration) noexcept
{
  share_ *= std::exp(-duration / RELAXATION);
  if (motor_step != 0.0)
  {
    const double end = motor_step > 0.0 ? 1.0 : -1.0;
    share_ = end + (share_ - end) * std::exp(-std::abs(motor_step) / angle_);
  }
  return share_;
}

MotionDriven::MotionDriven(const Parameters& parameters)
  : friction_(parameters)
  , presliding_(parameters.telemetry.presliding_angle)
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
  const double share = presliding_.move(ratio_ * (sample.position - last_.position), sample.time - last_.time);
  last_ = sample;

  const double friction = friction_.at(ratio_ * sample.velocity, sample.load, temperature_).sum();
  MotionPrediction prediction;
  prediction.friction_torque = ratio_ * share * friction;
  prediction.motor_torque = sample.load / ratio_ + inertia_ * ratio_ * sample.acceleration + share * friction;
  prediction.current = ratio_ * prediction.motor_torque / telemetry_.torque_per_current + telemetry_.current_offset;
  prediction.band = ratio_ * (1.0 - std::abs(share)) * friction / telemetry_.torque_per_current;
  return prediction;
}
}  // namespace hjt
