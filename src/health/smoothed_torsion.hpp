// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace hjt
{
/// Inputs of the drive's torsion at one instant.
struct TorsionSample
{
  double torsion;       ///< motor angle / ratio - output angle [rad]
  double torque;        ///< through the gear, > 0 resists positive motion [N.m]
  double motor_angle;   ///< [rad]
  double output_angle;  ///< [rad]
};

/// Torsion and the torque through the gear that twists it, inertia's share in it, smoothed alike.
///
/// Law:   x = F x_0,   T = F T_0 + J F d^2(phi) / dt^2,   F = 1 / (1 + s t)^2
/// where  x_0, T_0  torsion [rad] and angles as read; torque at one end of the gear [N.m]
///        J, phi    inertia between that end and the gear [kg.m^2], its angle [rad];  t  TIME [s]
/// All lag by the same 2 t, so that torsion and torque of one instant belong together in any motion.
class SmoothedTorsion
{
public:
  void reset() noexcept { age_ = -1.0; }

  /// `given`: as read, the torque without inertia's; `speed`: of phi [rad/s]; `seconds`: since the last sample.
  void update(const TorsionSample& given, double speed, double inertia, double seconds) noexcept
  {
    Values values;
    values << given.torsion, given.torque, given.motor_angle, given.output_angle, speed;
    if (age_ < 0.0)
    {
      age_ = 0.0;
      first_ = values;
      second_ = values;
    }
    const double last_speed = second_[SPEED];
    const double kept = std::exp(-seconds / TIME);
    first_ = kept * first_ + (1.0 - kept) * values;
    second_ = kept * second_ + (1.0 - kept) * first_;
    age_ += seconds;
    const double acceleration = (second_[SPEED] - last_speed) / seconds;
    sample_ = { second_[0], second_[1] + inertia * acceleration, second_[2], second_[3] };
  }

  /// Whether what was before the first sample is forgotten.
  bool settled() const noexcept { return age_ > 12.0 * TIME; }

  const TorsionSample& sample() const noexcept { return sample_; }

private:
  static constexpr double TIME = 0.02;  // [s]
  static constexpr int SPEED = 4;
  using Values = Eigen::Matrix<double, SPEED + 1, 1>;  // those of a sample, and the speed

  Values first_{ Values::Zero() };
  Values second_{ Values::Zero() };
  TorsionSample sample_{};
  double age_{ -1.0 };  // [s]; < 0: nothing came
};
}  // namespace hjt
