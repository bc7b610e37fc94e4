// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/running_regression.hpp"
#include "statics/torsion_curve.hpp"

namespace hjt
{
/// Torsion at one joint torque, both ways of turning apart: mean of the rows.
struct TorsionMean
{
  double torque{};    ///< [N.m]
  double forward{};   ///< NaN: never passed that way [rad]
  double backward{};  ///< [rad]
};

/// Torsion of a joint with two encoders, compared with the twin's curve. Memory is limited by the range of torques.
class TorsionPoints
{
public:
  /// @throws ParameterError if the ring finds no equilibrium under load.
  explicit TorsionPoints(const Parameters& parameters);

  /// `torque` at the output [N.m], `torsion` motor angle over ratio less joint angle, from any zero [rad], `position`
  /// of the joint [rad], `speed` [rad/s].
  void add(double torque, double torsion, double position, double speed);

  std::uint64_t rows() const { return rows_; }

  /// By torque, ascending, in steps; zero is where the twin's curve has it.
  std::vector<TorsionMean> means() const;

  /// Measured torsion over the twin's under the same torques, by least squares with an offset for each way of turning;
  /// NaN if the torque hardly varied.
  double compliance() const;
  double twinAmplitude() const;  ///< standard deviation of the twin's torsion under the same torques [rad]

  /// Largest standard deviation that a sine of the joint angle of amplitude 1 has, over all phases [-].
  double turnAmplitude() const;

private:
  static constexpr double STEPS = 142.0;       // up to the largest load
  static constexpr double MIN_VARIED = 20e-6;  // least standard deviation of the twin's torsion that allows an
                                               // estimate [rad]
  struct Bin
  {
    double sum{};
    double rows{};
  };

  RunningRegression fitted() const;

  double step_;  // of the torque [N.m]
  TorsionCurve curve_;
  RunningRegression regression_;  // of the torsion over: one, way of turning, the twin's torsion
  std::map<int, Bin> bins_[2];
  std::uint64_t rows_{};
  double twin_sum_{};
  double twin_squares_{};
  Eigen::Vector2d turn_sum_{ 0.0, 0.0 };  // of cosine and sine of the joint angle
  Eigen::Matrix2d turn_squares_{ Eigen::Matrix2d::Zero() };
};
}  // namespace hjt
