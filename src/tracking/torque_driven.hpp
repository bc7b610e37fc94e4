// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "elements/load.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "params/variants.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// The whole twin driven by a measured motor current, open loop: motion out. Differences from the robot accumulate.
///
/// The current of a sample drives from its time on. The weight is that at the measured angle, so that a twin gone
/// astray does not hang elsewhere. Starts at rest at the measured angle, and again after a gap.
class TorqueDriven
{
public:
  /// @throws ParameterError as the twin.
  explicit TorqueDriven(const Parameters& parameters, const SurfaceSource& surface_source = {})
    : twin_(withoutHeat(withoutWeight(parameters)), surface_source)
    , load_(parameters.output)
    , telemetry_(parameters.telemetry)
    , ratio_(nominalRatio(parameters.gear))
    , temperature_(parameters.input.temperature)
  {
  }

  struct Motion
  {
    double position{};         ///< of the joint, at the sample's time [rad]
    double velocity{};         ///< [rad/s]
    double joint_torque{};     ///< of the mesh on the output [N.m]
    double friction_torque{};  ///< of the whole, at the joint, against the motion [N.m]
  };

  /// State of the joint at the time of `sample`, whose current and load act from then on.
  /// @param load external torque at the output, without the configured weight and inertia [N.m]
  Motion step(const MotionSample& sample, double load) noexcept
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
    twin_.setTemperature(stamp, sample.temperatureOr(temperature_));
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

  std::uint64_t solverFailures() const noexcept { return solver_failures_ + twin_.counters().solver_failures; }

private:
  Twin twin_;
  Load load_;
  TelemetryParameters telemetry_;
  double ratio_;
  double temperature_;       // of samples without one [degC]
  double start_position_{};  // the twin's zero [rad]
  bool started_{};
  std::uint64_t solver_failures_{};  // before the last start
};
}  // namespace hjt
