// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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
/// Law:   a' = a + e sin a + e_2 sin 2 a + e_4 sin 4 a + s n
///                                   angle that an encoder resolves into counts   [rad]
///        T' = T + s_T n, rounded    torque estimated from the current [N.m]
/// where  e    amplitude that an eccentric disc or magnet brings, once a turn     [rad]
///        e_2, e_4  those of an oval disc and of a read head's two signals          [rad]
///        s    noise, root mean square, s_T of the torque                         [rad], [N.m]
///        n standard normal, a new number at every step: of seed, sensor and step      [-]
/// All readings have the same delay, in whole steps. An effect set to zero costs nothing and changes no bit.
class JointSensors
{
public:
  /// `period`: between two updates [s].
  JointSensors(const SensorParameters& parameters, double period)
    : parameters_(parameters)
    , noise_(static_cast<std::uint32_t>(parameters.noise_seed))
    , motor_encoder_(parameters)
    , output_encoder_(parameters)
    , motor_velocity_(parameters.velocity_window, period)
    , output_velocity_(parameters.velocity_window, period)
    , line_(1 + static_cast<std::size_t>(std::lround(parameters.delay / period)))
  {
  }

  void reset() noexcept
  {
    motor_velocity_.reset();
    output_velocity_.reset();
    filled_ = false;
  }

  /// Once every period. `step`: number of the instant, the same for the same stamp; angles [rad], torque [N.m].
  void update(std::int64_t step, double motor_angle, double output_angle, double motor_torque) noexcept
  {
    Sensed now{ motor_angle + lines(motor_angle, parameters_.motor_eccentricity, parameters_.motor_lines),
                output_angle + lines(output_angle, parameters_.output_eccentricity, parameters_.output_lines),
                motor_torque };
    if (parameters_.motor_noise > 0.0 || parameters_.output_noise > 0.0)
    {
      const std::array<double, 2> normals = noise_.normals(ENCODERS, step);
      now.motor_angle += parameters_.motor_noise * normals[0];
      now.output_angle += parameters_.output_noise * normals[1];
    }
    if (parameters_.torque_noise > 0.0)
    {
      now.motor_torque += parameters_.torque_noise * noise_.normals(TORQUE, step)[0];
    }
    if (parameters_.torque_resolution > 0.0)
    {
      now.motor_torque = parameters_.torque_resolution * std::round(now.motor_torque / parameters_.torque_resolution);
    }
    if (!filled_)
    {
      std::fill(line_.begin(), line_.end(), now);
      filled_ = true;
    }
    line_[oldest_] = now;
    oldest_ = oldest_ + 1 == line_.size() ? 0 : oldest_ + 1;
    motor_velocity_.update(sensed().motor_angle);
    output_velocity_.update(sensed().output_angle);
  }

  EncoderReadings encoders() const noexcept
  {
    EncoderReadings readings;
    readings.motor_count = motor_encoder_.count(sensed().motor_angle);
    readings.motor_angle = motor_encoder_.angle(readings.motor_count);
    readings.motor_velocity =
        motor_velocity_.velocity([this](double angle) { return motor_encoder_.angle(motor_encoder_.count(angle)); });
    readings.output_count = output_encoder_.count(sensed().output_angle);
    readings.output_angle = output_encoder_.unwrappedAngle(sensed().output_angle);
    readings.output_velocity =
        output_velocity_.velocity([this](double angle) { return output_encoder_.unwrappedAngle(angle); });
    return readings;
  }

  double motorTorque() const noexcept { return sensed().motor_torque; }  ///< [N.m]

private:
  enum Channel : std::uint32_t
  {
    ENCODERS,
    TORQUE
  };

  /// What the sensors' resolution has still to be applied to, of angles; torque as it is read.
  struct Sensed
  {
    double motor_angle{};
    double output_angle{};
    double motor_torque{};
  };

  const Sensed& sensed() const noexcept { return line_[oldest_]; }

  /// Error of an encoder that comes back every turn [rad].
  static double lines(double angle, double eccentricity, const std::array<double, 2>& others) noexcept
  {
    double error = 0.0;
    const auto add = [&](double amplitude, double order)
    {
      if (amplitude != 0.0)
      {
        error += amplitude * std::sin(order * angle);
      }
    };
    add(eccentricity, 1.0);
    add(others[0], 2.0);
    add(others[1], 4.0);
    return error;
  }

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
