// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "harmonic_joint_twin/health/indicator.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// What the motor's torque goes into, over one window: inertia, and friction that grows with the load.
///
/// Law:   F tau = J F a + C F sign(omega) + g_0 [ + g_c F cos(phi) + g_s F sin(phi) ],  F = 1 / (1 + s t)^2
///        F tau = J F a + C F sign(omega) + g_0 + B F omega + l F(sign(omega) |T| / i)   where the motor moves
/// where  tau            motor torque less the load's [N.m];  a, omega  motor acceleration [rad/s^2], speed [rad/s]
///        C              friction: without its column what changes with the temperature or a fault would count as
///                       inertia, for the friction turns round with the motion
///        phi            output angle [rad]; g_c, g_s: weight, where the load is not known
///        B              viscous friction;  T, i  load torque [N.m], ratio;  l  friction by load [-]: needs a load
///                       that varies
///        t              TIME [s]
/// A motion of less than LEAST_ACCELERATION rms, or whose weight goes as its acceleration, has no inertia to see: it
/// goes to 0.
class TorqueBalance
{
public:
  TorqueBalance() : regression_(COLUMNS, 1), friction_(COLUMNS, 1) {}

  void reset() noexcept
  {
    restart();
    started_ = false;
  }

  /// The next window.
  void restart() noexcept
  {
    regression_.reset();
    friction_.reset();
  }

  /// Every sample. `torque`: less the load's; `load`: at the motor, NaN: not known [N.m]; `seconds` since the last one.
  void add(double torque, double load, double velocity, double output_angle, double seconds, bool moving) noexcept
  {
    const double direction = std::copysign(1.0, velocity);
    Values values;
    values << torque, velocity, direction, std::cos(output_angle), std::sin(output_angle),
        direction * (std::isfinite(load) ? std::abs(load) : 0.0);
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
    const Eigen::Matrix<double, 1, 1> balance(second_[0]);
    regression_.add(row, balance);
    if (moving)
    {
      row.tail<2>() << second_[1], second_[5];
      friction_.add(row, balance);
    }
  }

  /// At the motor [kg.m^2].
  double fit(bool load_known) noexcept
  {
    Eigen::Matrix<double, COLUMNS, 1> row = Eigen::Matrix<double, COLUMNS, 1>::Zero();
    row[0] = LEAST_ACCELERATION * std::sqrt(regression_.rows());
    regression_.add(row, Eigen::Matrix<double, 1, 1>(0.0));
    return regression_.fit(load_known ? COLUMNS - 2 : COLUMNS) ? regression_.coefficient(0, 0) : 0.0;
  }

  /// [-]
  Indicator loadFriction() noexcept
  {
    constexpr int LOAD = COLUMNS - 1;
    const bool told = friction_.fit(COLUMNS) && friction_.mean(LOAD, LOAD) > 0.0;
    return { told && friction_.inflation(LOAD) < MAX_INFLATION, friction_.coefficient(LOAD, 0) };
  }

private:
  static constexpr int COLUMNS = 5;
  static constexpr double MAX_INFLATION = 30.0;       // of the variance of the friction by load [-]
  static constexpr double TIME = 0.02;                // [s]
  static constexpr double LEAST_ACCELERATION = 20.0;  // rms, of the motor [rad/s^2]
  using Values = Eigen::Matrix<double, COLUMNS + 1, 1>;

  RunningRegression regression_;
  RunningRegression friction_;
  Values first_{ Values::Zero() };
  Values second_{ Values::Zero() };
  bool started_{};
};
}  // namespace hjt
