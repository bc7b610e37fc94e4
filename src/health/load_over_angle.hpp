// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Dense>

namespace hjt
{
/// Payload of a joint, from its load torque over its angle: a payload gives the same on any path.
///
/// Law:   T = c + s sin(phi) + k cos(phi),  least squares over the time
/// where  T, phi  load torque [N.m], output angle [rad];  s, k  weight;  c  what does not depend on the angle
/// An angle that varies by less than some 0.3 deg rms determines c alone: s and k go to 0.
class LoadOverAngle
{
public:
  using Coefficients = Eigen::Vector3d;  // c, s, k [N.m]

  void add(double angle, double torque, double seconds) noexcept
  {
    const Eigen::Vector3d row(1.0, std::sin(angle), std::cos(angle));
    normal_.noalias() += seconds * row * row.transpose();
    right_.noalias() += seconds * torque * row;
  }

  /// NaN: nothing came.
  Coefficients coefficients() const noexcept
  {
    constexpr double LEAST_SQUARE = 2.5e-5;  // of the sine and cosine about their means [-]
    const double time = normal_(0, 0);
    const Eigen::Vector2d mean = normal_.col(0).tail<2>() / time;
    const double mean_torque = right_[0] / time;
    Eigen::Matrix2d squares = normal_.bottomRightCorner<2, 2>() - time * mean * mean.transpose();
    squares.diagonal().array() += LEAST_SQUARE * time;
    const Eigen::Vector2d weight = squares.inverse() * (right_.tail<2>() - time * mean_torque * mean);
    return { mean_torque - mean.dot(weight), weight[0], weight[1] };
  }

private:
  Eigen::Matrix3d normal_{ Eigen::Matrix3d::Zero() };
  Eigen::Vector3d right_{ Eigen::Vector3d::Zero() };
};
}  // namespace hjt
