// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tracking/torque_ripple.hpp"

namespace hjt
{
/// Motor torque less load, inertia and friction, at one instant.
struct RippleRow
{
  double position;  ///< of the joint [rad]
  double velocity;  ///< [rad/s]
  double torque;    ///< at the joint [N.m]
};

/// The lines of TorqueRipple in that torque, by least squares, outliers less (Huber), with the resonance of what the
/// joint carries. A line that is lost in the residual is refused, and zero. Rows count up to the speed of KNOWN of
/// them, and to that at which a wave of two a turn of the motor still has two rows. Four a turn are refused if they
/// have fewer there.
class RippleFit
{
public:
  static constexpr double KNOWN = 0.95;  ///< of the rows

  /// `rows`: rows that move, every `period` [s] where no row is lost. `start`: what is configured, which the resonance
  /// falls back to without a line. `look` as in identify.
  RippleFit(std::vector<RippleRow> rows, double period, const TelemetryParameters& start, double ratio,
            const std::function<void()>& look);

  const TorqueRipple::Orders& orders() const { return orders_; }
  std::array<double, 2> line(std::size_t line) const { return { values_[2 * line], values_[2 * line + 1] }; }
  double amplitude(std::size_t line) const;  ///< [N.m at the joint]
  double halfWidth(std::size_t line) const;  ///< of its 95 % interval [N.m]
  double phase(std::size_t line) const;      ///< of the cosine at joint angle 0 [rad]
  const std::string& refusal(std::size_t line) const { return refusal_[line]; }

  void store(TelemetryParameters& parameters) const;  ///< writes the lines and their resonance

private:
  static constexpr std::size_t RESONANCE = 2 * TorqueRipple::LINES;  // where the response stands behind the lines
  static constexpr std::size_t VALUES = RESONANCE + 3;
  using Values = Eigen::Matrix<double, VALUES, 1>;

  bool anyLine() const;
  Eigen::MatrixXd waves(const double* response) const;
  Eigen::MatrixXd slopes(const Values& values) const;
  void chooseResonance(const std::function<void()>& look);
  void solve();
  bool refuseWorst();

  std::vector<RippleRow> rows_;
  Eigen::VectorXd torque_;  // of the rows
  TorqueRipple::Orders orders_;
  double fastest_;  // [rad/s]
  Values values_ = Values::Zero();
  Values half_width_ = Values::Zero();
  std::array<bool, TorqueRipple::LINES> present_{};
  std::array<std::string, TorqueRipple::LINES> refusal_;
};
}  // namespace hjt
