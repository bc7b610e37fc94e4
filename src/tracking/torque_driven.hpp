// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "elements/load.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
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
  explicit TorqueDriven(const Parameters& parameters, const SurfaceSource& surface_source = {});

  struct Motion
  {
    double position{};         ///< of the joint, at the sample's time [rad]
    double velocity{};         ///< [rad/s]
    double joint_torque{};     ///< of the mesh on the output [N.m]
    double friction_torque{};  ///< of the whole, at the joint, against the motion [N.m]
  };

  /// State of the joint at the time of `sample`, whose current and load act from then on.
  /// @param load external torque at the output, without the configured weight and inertia [N.m]
  Motion step(const MotionSample& sample, double load) noexcept;

  std::uint64_t solverFailures() const noexcept { return solver_failures_ + twin_.counters().solver_failures; }

private:
  Twin twin_;
  Load load_;
  TelemetryParameters telemetry_;
  double ratio_;
  double start_position_{};  // the twin's zero [rad]
  bool started_{};
  std::uint64_t solver_failures_{};  // before the last start
};
}  // namespace hjt
