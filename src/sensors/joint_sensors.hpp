// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/sensors/encoder_readings.hpp"
#include "sensors/absolute_encoder.hpp"
#include "sensors/counter_noise.hpp"
#include "sensors/incremental_encoder.hpp"
#include "sensors/velocity_estimate.hpp"

namespace hjt
{
/// The sensors of a joint: both encoders and the motor's current, which is read as a torque.
///
/// Law:   a' = a + e sin a + s n     angle that an encoder resolves into counts   [rad]
///        T' = T + s_T n, rounded    torque estimated from the current [N.m]
/// where  e    amplitude that an eccentric disc or magnet brings, once a turn     [rad]
///        s    noise, root mean square, s_T of the torque                         [rad], [N.m]
///        n standard normal, a new number at every step: of seed, sensor and step      [-]
/// All readings have the same delay, in whole steps. An effect set to zero costs nothing and changes no bit.
class JointSensors
{
public:
  /// `period`: between two updates [s].
  JointSensors(const SensorParameters& parameters, double period);

  void reset() noexcept;

  /// Once every period. `step`: number of the instant, the same for the same stamp; angles [rad], torque [N.m].
  void update(std::int64_t step, double motor_angle, double output_angle, double motor_torque) noexcept;

  EncoderReadings encoders() const noexcept;
  double motorTorque() const noexcept { return sensed().motor_torque; }  ///< [N.m]

private:
  /// What the sensors' resolution has still to be applied to, of angles; torque as it is read.
  struct Sensed
  {
    double motor_angle{};
    double output_angle{};
    double motor_torque{};
  };

  const Sensed& sensed() const noexcept { return line_[oldest_]; }

  SensorParameters parameters_;
  CounterNoise noise_;
  IncrementalEncoder motor_encoder_;
  AbsoluteEncoder output_encoder_;
  VelocityEstimate motor_velocity_;
  VelocityEstimate output_velocity_;
  std::vector<Sensed> line_;  // ring: one more than the delay has steps
  std::size_t oldest_{};
  bool filled_{};
};
}  // namespace hjt
