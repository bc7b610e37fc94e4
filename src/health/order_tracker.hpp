// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/health/tracked_lines.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// One sample as the tracker takes it.
struct LineSample
{
  double motor_angle{};      ///< [rad]
  double output_angle{};     ///< [rad]
  double direction{};        ///< +1 or -1
  double speed{};            ///< mean over about a turn, signed [rad/s]
  double load{};             ///< at the joint, 0: not known [N.m]
  double kinematic_error{};  ///< motor angle / ratio - output angle [rad]
  double motor_torque{};     ///< [N.m]
};

struct LineFit
{
  bool valid{};
  double cosine{};  ///< [rad] or [N.m]
  double sine{};
  double error{};  ///< standard error of the amplitude
  double amplitude() const noexcept;
};

/// Amplitude and phase of lines at known orders, in kinematic error and motor torque at once.
///
/// Law:   y(t) = b . n(t) + sum_k ( a_k cos(o_k theta(t)) + b_k sin(o_k theta(t)) ),  least squares over one window
/// where  theta  motor angle of the very sample [rad];  o_k  order [1/turn]
///        n      what is no line: 1, direction, speed, cos and sin of the output angle (weight, runout), load T, T |T|, T^3
///               (the torsion is no straight line over the load)
/// Nothing is resampled and no speed need be constant: the line is a function of the angle, whichever way and however
/// fast it is passed, and the motion may go back and forth. Lines fitted at once do not leak into each other.
///
/// Not valid: a line above 0.8 of half the samples a turn, and one that the travel cannot tell from another (variance
/// inflated more than fourfold: orders o1, o2 need about 0.3 / |o1 - o2| turns in all, 15 for 1.98 beside 2).
class OrderTracker
{
public:
  explicit OrderTracker(const LineOrders& orders);

  void reset() noexcept;  ///< forgets the window, not the last fit
  void add(const LineSample& sample) noexcept;

  /// `angle_step`: mean travel between two samples [rad]. False: too little came.
  bool fit(double angle_step) noexcept;

  LineFit line(LineSignal signal, std::size_t line) const noexcept;

  /// Kinematic error of the last added sample less what the last fit makes of it [rad].
  double residual() const noexcept;

private:
  static constexpr int NUISANCES = 8;
  static constexpr int COLUMNS = NUISANCES + 2 * static_cast<int>(LINE_COUNT);

  LineOrders orders_;
  Eigen::VectorXd row_;
  Eigen::Vector2d targets_;
  RunningRegression regression_;
  int used_{};           // columns of the last fit
  double angle_step_{};  // of the last fit [rad]
};
}  // namespace hjt
