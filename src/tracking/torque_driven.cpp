// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/torque_driven.hpp"

#include <cmath>

#include "gear/ratio.hpp"
#include "params/variants.hpp"

namespace hjt
{
TorqueDriven::TorqueDriven(const Parameters& parameters, const SurfaceSource& surface_source)
  : twin_(withoutWeight(parameters), surface_source)
  , load_(parameters.output)
  , telemetry_(parameters.telemetry)
  , ratio_(nominalRatio(parameters.gear))
{
}

TorqueDriven::Motion TorqueDriven::step(const MotionSample& sample, double load) noexcept
{
  const Stamp stamp = std::llround(1e9 * sample.time);
  if (!started_ || sample.after_gap)
  {
    solver_failures_ = solverFailures();
    twin_.reset(stamp);
    start_position_ = sample.position;
    started_ = true;
  }
  while (twin_.step(stamp))
  {
  }
  twin_.commandMotorTorque(stamp,
                           telemetry_.torque_per_current * (sample.current - telemetry_.current_offset) / ratio_);
  twin_.commandLoadTorque(stamp, load - load_.gravityTorque(sample.position));

  const JointOutputs& now = twin_.outputs();
  Motion motion;
  motion.velocity = now.output_velocity;
  motion.position =
      start_position_ + now.output_angle + 1e-9 * static_cast<double>(stamp - now.stamp) * now.output_velocity;
  motion.joint_torque = now.joint_torque;
  motion.friction_torque = std::copysign(ratio_ * now.friction_torque, now.motor_velocity);
  return motion;
}
}  // namespace hjt
