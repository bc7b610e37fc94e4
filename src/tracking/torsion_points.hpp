// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// Torsion at one joint torque, both ways of turning apart: mean of the rows.
struct TorsionMean
{
  double torque{};    ///< [N.m]
  double forward{};   ///< NaN: never passed that way [rad]
  double backward{};  ///< [rad]
};

/// Torsion of a joint with two encoders, compared with the twin's under the same course of loads, for torques up to
/// output.load_torque_limit. Memory is fixed; `add` neither allocates nor throws.
class TorsionPoints
{
public:
  explicit TorsionPoints(const Parameters& parameters)
    : step_(std::max(parameters.output.load_torque_limit, 1.0) / STEPS), regression_(3, 1)
  {
    bins_.fill(std::vector<Bin>(2 * static_cast<std::size_t>(STEPS) + 1));
  }

  void reset() noexcept
  {
    regression_.reset();
    for (std::vector<Bin>& way : bins_)
    {
      std::fill(way.begin(), way.end(), Bin());
    }
    rows_ = 0;
    twin_sum_ = twin_squares_ = 0.0;
    turn_sum_.setZero();
    turn_squares_.setZero();
  }

  /// `torque` at the output [N.m], `twin` the torsion of the twin under it [rad], `torsion` motor angle over ratio less
  /// joint angle, from any zero [rad], `position` of the joint [rad], `speed` [rad/s].
  void add(double torque, double twin, double torsion, double position, double speed) noexcept
  {
    const double way = speed < 0.0 ? -1.0 : 1.0;
    regression_.add(Eigen::Vector3d(1.0, way, twin), Eigen::Matrix<double, 1, 1>(torsion));
    ++rows_;
    twin_sum_ += twin;
    twin_squares_ += twin * twin;
    const Eigen::Vector2d turn(std::cos(position), std::sin(position));
    turn_sum_ += turn;
    turn_squares_ += turn * turn.transpose();
    Bin& bin = bins_[speed < 0.0 ? 1 : 0][static_cast<std::size_t>(std::lround(torque / step_ + STEPS))];
    bin.sum += torsion;
    bin.rows += 1.0;
  }

  std::uint64_t rows() const { return rows_; }

  /// By torque, ascending, in steps; zero is where the twin's curve has it.
  std::vector<TorsionMean> means() const
  {
    std::vector<TorsionMean> means;
    if (rows_ == 0)
    {
      return means;
    }
    const double zero = fitted().coefficient(0, 0);
    const auto mean_of = [&](const Bin& bin) { return bin.rows > 0.0 ? bin.sum / bin.rows - zero : std::nan(""); };
    for (std::size_t step = 0; step < bins_[0].size(); ++step)
    {
      if (bins_[0][step].rows + bins_[1][step].rows > 0.0)
      {
        means.push_back(
            { (static_cast<double>(step) - STEPS) * step_, mean_of(bins_[0][step]), mean_of(bins_[1][step]) });
      }
    }
    return means;
  }

  /// Measured torsion over the twin's under the same torques, by least squares with an offset for each way of turning;
  /// NaN if the torque hardly varied.
  double compliance() const
  {
    return twinAmplitude() < MIN_VARIED ? std::numeric_limits<double>::quiet_NaN() : fitted().coefficient(2, 0);
  }

  /// Standard deviation of the twin's torsion under the same torques [rad]
  double twinAmplitude() const
  {
    const auto n = static_cast<double>(rows_);
    return rows_ == 0 ? 0.0 : std::sqrt(std::max(0.0, twin_squares_ / n - std::pow(twin_sum_ / n, 2)));
  }

  /// Largest standard deviation that a sine of the joint angle of amplitude 1 has, over all phases [-].
  double turnAmplitude() const
  {
    const double n = std::max(static_cast<double>(rows_), 1.0);
    const Eigen::Matrix2d squares = turn_squares_ / n - turn_sum_ * turn_sum_.transpose() / (n * n);
    // The root of the larger eigenvalue.
    return std::sqrt(0.5 * squares.trace() + std::hypot(0.5 * (squares(0, 0) - squares(1, 1)), squares(0, 1)));
  }

private:
  static constexpr double STEPS = 142.0;       // up to the largest load
  static constexpr double MIN_VARIED = 20e-6;  // least standard deviation of the twin's torsion that allows an
                                               // estimate [rad]
  struct Bin
  {
    double sum{};
    double rows{};
  };

  RunningRegression fitted() const
  {
    RunningRegression regression = regression_;
    regression.fit(3);
    return regression;
  }

  double step_;                           // of the torque [N.m]
  RunningRegression regression_;          // of the torsion over: one, way of turning, the twin's torsion
  std::array<std::vector<Bin>, 2> bins_;  // by way of turning: torques from the least to the largest
  std::uint64_t rows_{};
  double twin_sum_{};
  double twin_squares_{};
  Eigen::Vector2d turn_sum_{ 0.0, 0.0 };  // of cosine and sine of the joint angle
  Eigen::Matrix2d turn_squares_{ Eigen::Matrix2d::Zero() };
};
}  // namespace hjt
