// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "messages/conversions.hpp"
#include "sensors/joint_sensors.hpp"
#include "tracking/measured_gear.hpp"
#include "tracking/tracker.hpp"

namespace hjt
{
/// The drive of a measured joint, and what its messages hold: the gear at the measured angle under the joint's torque
/// of the moment.
class MeasuredDrive
{
public:
  /// @throws ParameterError as MeasuredGear.
  explicit MeasuredDrive(const Parameters& parameters);

  /// To the row of a comparison; `fill` is of that one. False: no equilibrium, counted. Neither throws nor allocates.
  bool moveTo(const Comparison& comparison) noexcept;
  std::uint64_t failures() const noexcept { return failures_; }

  /// Takes the torques of a row into those of the next Health; where none is wanted they are forgotten.
  void note(const Comparison& comparison, bool is_wanted) noexcept;

  void fill(Stamp stamp, harmonic_joint_twin::ContactForces& message) noexcept;
  void fill(Stamp stamp, harmonic_joint_twin::Stress& message) noexcept;
  /// The noise of the sensors is that of the sample in the stamp's period of publish.encoders_rate.
  void fill(Stamp stamp, harmonic_joint_twin::Encoders& message) noexcept;
  /// Values of one instant; those that take a turn of the drive are not valid.
  void fill(Stamp stamp, harmonic_joint_twin::Health& message) noexcept;

private:
  double motorTorque(const Comparison& comparison) const noexcept;
  double meshForceError() const noexcept;  // [N]

  const GearParameters dimensions_;
  const RingParameters ring_;
  const StressParameters stress_;
  const FatigueLaw fatigue_law_;
  const TelemetryParameters telemetry_;
  const Stamp encoders_period_;  // [ns]
  const double ratio_;
  MeasuredGear gear_;
  JointSensors sensors_;
  Comparison now_;
  double motor_torque_{};  // [N.m]
  SinceMessage since_;     // that of Health
  std::uint64_t failures_{};
};
}  // namespace hjt
