// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/joint_sensors.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
enum Channel : std::uint32_t
{
  ENCODERS,
  TORQUE
};
}  // namespace

JointSensors::JointSensors(const SensorParameters& parameters, double period)
  : parameters_(parameters)
  , noise_(static_cast<std::uint32_t>(parameters.noise_seed))
  , motor_encoder_(parameters)
  , output_encoder_(parameters)
  , motor_velocity_(parameters.velocity_window, period)
  , output_velocity_(parameters.velocity_window, period)
  , line_(1 + static_cast<std::size_t>(std::lround(parameters.delay / period)))
{
}

void JointSensors::reset() noexcept
{
  motor_velocity_.reset();
  output_velocity_.reset();
  filled_ = false;
}

void JointSensors::update(std::int64_t step, double motor_angle, double output_angle, double motor_torque) noexcept
{
  Sensed now{ motor_angle, output_angle, motor_torque };
  if (parameters_.motor_eccentricity != 0.0)
  {
    now.motor_angle += parameters_.motor_eccentricity * std::sin(motor_angle);
  }
  if (parameters_.output_eccentricity != 0.0)
  {
    now.output_angle += parameters_.output_eccentricity * std::sin(output_angle);
  }
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
  motor_velocity_.update(motor_encoder_.angle(motor_encoder_.count(sensed().motor_angle)));
  output_velocity_.update(output_encoder_.unwrappedAngle(sensed().output_angle));
}

EncoderReadings JointSensors::encoders() const noexcept
{
  EncoderReadings readings;
  readings.motor_count = motor_encoder_.count(sensed().motor_angle);
  readings.motor_angle = motor_encoder_.angle(readings.motor_count);
  readings.motor_velocity = motor_velocity_.velocity();
  readings.output_count = output_encoder_.count(sensed().output_angle);
  readings.output_angle = output_encoder_.unwrappedAngle(sensed().output_angle);
  readings.output_velocity = output_velocity_.velocity();
  return readings;
}
}  // namespace hjt
