// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "health/running_regression.hpp"

namespace hjt
{
/// Inertia that the motor moves, over one window.
///
/// Law:   F tau = J F a + C F sign(omega) + g_0 [ + g_c F cos(phi) + g_s F sin(phi) ],  F = 1 / (1 + s t)^2
/// where  tau            motor torque less the load's [N.m];  a, omega  motor acceleration [rad/s^2], speed [rad/s]
///        C              friction: without its column what changes with the temperature or a fault would count as
///                       inertia, for the friction turns round with the motion
///        phi            output angle [rad]; g_c, g_s: weight, where the load is not known
///        t              TIME [s]
/// A motion of less than LEAST_ACCELERATION rms, or whose weight goes as its acceleration, has no inertia to see: it
/// goes to 0.
class InertiaEstimate
{
public:
  InertiaEstimate() : regression_(COLUMNS, 1) {}

  void reset() noexcept
  {
    regression_.reset();
    started_ = false;
  }

  /// The next window.
  void restart() noexcept { regression_.reset(); }

  /// Every sample; `seconds` since the last one.
  void add(double torque, double velocity, double output_angle, double seconds) noexcept
  {
    Values values;
    values << torque, velocity, std::copysign(1.0, velocity), std::cos(output_angle), std::sin(output_angle);
    if (!started_)
    {
      started_ = true;
      first_ = values;
      second_ = values;
    }
    const double last_speed = second_[1];
    const double kept = std::exp(-seconds / TIME);
    first_ = kept * first_ + (1.0 - kept) * values;
    second_ = kept * second_ + (1.0 - kept) * first_;
    Eigen::Matrix<double, COLUMNS, 1> row;
    row << (second_[1] - last_speed) / seconds, second_[2], 1.0, second_[3], second_[4];
    regression_.add(row, Eigen::Matrix<double, 1, 1>(second_[0]));
  }

  /// At the motor [kg.m^2].
  double fit(bool load_known) noexcept
  {
    Eigen::Matrix<double, COLUMNS, 1> row = Eigen::Matrix<double, COLUMNS, 1>::Zero();
    row[0] = LEAST_ACCELERATION * std::sqrt(regression_.rows());
    regression_.add(row, Eigen::Matrix<double, 1, 1>(0.0));
    return regression_.fit(load_known ? COLUMNS - 2 : COLUMNS) ? regression_.coefficient(0, 0) : 0.0;
  }

private:
  static constexpr int COLUMNS = 5;
  static constexpr double TIME = 0.02;                // [s]
  static constexpr double LEAST_ACCELERATION = 20.0;  // rms, of the motor [rad/s^2]
  using Values = Eigen::Matrix<double, COLUMNS, 1>;

  RunningRegression regression_;
  Values first_{ Values::Zero() };
  Values second_{ Values::Zero() };
  bool started_{};
};
}  // namespace hjt
