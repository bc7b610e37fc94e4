// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tracking/motion_differentiator.hpp"
#include "tracking/telemetry_fit.hpp"

namespace hjt
{
/// Regression of a joint's current over the last two minutes of motion on a constant, the sign of the speed (Coulomb
/// friction), the speed (viscous friction), the acceleration (inertia of the rotor) and the load.
class LoadRegression
{
public:
  void add(double step, double velocity, double acceleration, double load, double current) noexcept
  {
    constexpr double MEMORY = 120.0;  // time constant with which the regression forgets rows, in time of motion [s]
    Eigen::Matrix<double, OTHERS + 2, 1> row;
    row << 1.0, std::copysign(1.0, velocity), velocity, acceleration, load, current;
    sums_ = (1.0 - step / MEMORY) * sums_ + step * row * row.transpose();
  }

  double seconds() const { return sums_(0, 0); }
  /// Sums over time of load^2, load x current and current^2 [A^2 s], as a 2 x 2 matrix, after subtraction of the parts
  /// that constant, friction and acceleration explain.
  Eigen::Matrix2d left() const;
  /// Mean square of the current that no column of the regression explains [A^2]; NaN: too little motion.
  double leftByLoad() const;
  /// Slope of the current over the load; NaN: the load varies too little. Sets `content` to the integral over time of
  /// the square of the load that the other columns do not explain [A^2 s].
  FittedFactor slope(double& content) const;
  /// Slope of the current over the load, from the result of left() [A^2 s] and the time of its sums [s].
  static FittedFactor slopeOf(const Eigen::Matrix2d& left, double seconds);

private:
  static constexpr int OTHERS = 4;
  static constexpr double MIN_SECONDS = 5.0;
  // Sums over time of the products of the columns 1, sign, speed, acceleration, load and current with each other.
  Eigen::Matrix<double, OTHERS + 2, OTHERS + 2> sums_ = Eigen::Matrix<double, OTHERS + 2, OTHERS + 2>::Zero();
};

/// One LoadRegression for each of several lags of the current behind the motion. At most one row in 20 ms counts.
/// Between rows the class interpolates the motion. Only motion faster than MotionDifferentiator::SLIDING counts.
/// Nothing allocates.
class CurrentLag
{
public:
  static constexpr double LONGEST = 0.4;   ///< longest lag [s]
  static constexpr double SPACING = 0.04;  ///< difference between two neighbouring lags [s]
  static constexpr std::size_t LAGS = 21;

  /// Lag number `i` of the current behind the motion [s].
  static constexpr double lagAt(std::size_t i) { return SPACING * static_cast<double>(i) - LONGEST; }

  void reset() noexcept { *this = CurrentLag(); }

  /// Adds a row that is later than the row before. `load`: load of the joint, as a current of the motor [A].
  void add(const MotionSample& sample, double load) noexcept
  {
    if (end_ > begin_)
    {
      const double step = sample.time - at(end_ - 1).time;
      if (step >= 0.0 && step < PERIOD)
      {
        return;
      }
      begin_ = step < 0.0 || step > MotionDifferentiator::MAX_GAP ? end_ : begin_;
    }
    rows_[end_ % ROOM] = { sample.time, sample.velocity, sample.acceleration, load, sample.current };
    ++end_;
    take();
  }

  /// Result of LoadRegression::leftByLoad() for each lag [A^2].
  std::array<double, LAGS> left() const
  {
    std::array<double, LAGS> left;
    for (std::size_t i = 0; i < LAGS; ++i)
    {
      left[i] = regressions_[i].leftByLoad();
    }
    return left;
  }

  const LoadRegression& now() const { return regressions_[LAGS / 2]; }  ///< the regression for the lag 0

private:
  static constexpr double PERIOD = 0.019;  // least time between two rows that count [s]
  static constexpr std::size_t ROOM = 64;  // number of held rows, which cover more than twice LONGEST

  struct Row
  {
    double time;
    double velocity;
    double acceleration;
    double load;
    double current;
  };
  const Row& at(std::uint64_t index) const noexcept { return rows_[index % ROOM]; }

  /// Adds to each regression the current of the middle held row, with the motion earlier by the lag of the regression.
  void take() noexcept
  {
    const std::uint64_t oldest = std::max(begin_, end_ > ROOM ? end_ - ROOM : 0);
    const double newest = at(end_ - 1).time;
    std::uint64_t middle = end_ - 1;
    while (middle > oldest && newest - at(middle).time < LONGEST)
    {
      --middle;
    }
    const Row& now = at(middle);
    if (newest - now.time < LONGEST || now.time - at(oldest).time < LONGEST)
    {
      return;
    }
    const double step = now.time - at(middle - 1).time;
    std::uint64_t above = end_ - 1;
    for (std::size_t i = 0; i < LAGS; ++i)  // from the largest lag to the smallest
    {
      const double time = now.time - lagAt(i);
      while (above > oldest + 1 && at(above - 1).time >= time)
      {
        --above;
      }
      const Row& high = at(above);
      const Row& low = at(above - 1);
      const double share = (time - low.time) / (high.time - low.time);
      const auto between = [&](double Row::*value) { return low.*value + share * (high.*value - low.*value); };
      const double velocity = between(&Row::velocity);
      if (std::abs(velocity) > MotionDifferentiator::SLIDING)
      {
        regressions_[i].add(step, velocity, between(&Row::acceleration), between(&Row::load), now.current);
      }
    }
  }

  std::array<Row, ROOM> rows_{};
  std::uint64_t begin_{};  // number of the first row after the last gap
  std::uint64_t end_{};
  std::array<LoadRegression, LAGS> regressions_{};
};

/// Lag of an arm's currents behind the motion on which most joints of the arm agree [s]; 0: no clear lag. `left`:
/// result of CurrentLag::left() for each joint.
double commonLag(const std::vector<std::array<double, CurrentLag::LAGS>>& left);

/// Lag of the current of a single joint behind its motion [s]; 0: no clear lag. The lag must be longer and reduce the
/// residual more than a lag that commonLag() finds. `left`: result of CurrentLag::left().
double ownLag(const std::array<double, CurrentLag::LAGS>& left);
}  // namespace hjt
