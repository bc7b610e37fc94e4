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
/// Regression of a joint's current on a constant, Coulomb and viscous friction, the acceleration, which draws the
/// current of the rotor's inertia, and the load, of the last two minutes of motion.
class LoadRegression
{
public:
  void add(double step, double velocity, double acceleration, double load, double current) noexcept
  {
    constexpr double MEMORY = 120.0;  // of motion [s]
    Eigen::Matrix<double, OTHERS + 2, 1> row;
    row << 1.0, std::copysign(1.0, velocity), velocity, acceleration, load, current;
    sums_ = (1.0 - step / MEMORY) * sums_ + step * row * row.transpose();
  }

  double seconds() const { return sums_(0, 0); }
  /// Sums of load and current without constant, friction and acceleration [A^2 s].
  Eigen::Matrix2d left() const;
  /// Mean square of the current that the load leaves too [A^2]; NaN: too little motion.
  double leftByLoad() const;
  /// Slope of the current over the load; NaN: it says too little of it. `content`: square of the load that the others
  /// do not explain, summed over time.
  FittedFactor slope(double& content) const;
  /// The same by the sums of what `left` gives [A^2 s], over that time [s].
  static FittedFactor slopeOf(const Eigen::Matrix2d& left, double seconds);

private:
  static constexpr int OTHERS = 4;
  static constexpr double MIN_SECONDS = 5.0;
  // of 1, sign, speed, acceleration, load, current
  Eigen::Matrix<double, OTHERS + 2, OTHERS + 2> sums_ = Eigen::Matrix<double, OTHERS + 2, OTHERS + 2>::Zero();
};

/// That regression if the current came earlier or later than the motion. Fixed memory; nothing allocates.
///
/// Rows count at most every 20 ms, the motion between them on lines. Of motion faster than
/// MotionDifferentiator::SLIDING.
class CurrentLag
{
public:
  static constexpr double LONGEST = 0.4;   ///< [s]
  static constexpr double SPACING = 0.04;  ///< between lags tried [s]
  static constexpr std::size_t LAGS = 21;

  /// Of the current behind the motion [s].
  static constexpr double lagAt(std::size_t i) { return SPACING * static_cast<double>(i) - LONGEST; }

  void reset() noexcept { *this = CurrentLag(); }

  /// A row, later than the one before. `load`: as a current [A].
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

  /// Mean square of what is left of the current at each lag [A^2]; NaN: too little motion.
  std::array<double, LAGS> left() const
  {
    std::array<double, LAGS> left;
    for (std::size_t i = 0; i < LAGS; ++i)
    {
      left[i] = regressions_[i].leftByLoad();
    }
    return left;
  }

  /// As it came.
  const LoadRegression& now() const { return regressions_[LAGS / 2]; }

private:
  static constexpr double PERIOD = 0.019;  // of rows that count [s]
  static constexpr std::size_t ROOM = 64;  // rows: more than twice LONGEST at PERIOD

  struct Row
  {
    double time;
    double velocity;
    double acceleration;
    double load;
    double current;
  };
  const Row& at(std::uint64_t index) const noexcept { return rows_[index % ROOM]; }

  /// The current in the middle of what is held, beside the motion before and after it.
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
    for (std::size_t i = 0; i < LAGS; ++i)  // lags in descending order
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
  std::uint64_t begin_{};  // first row without a gap
  std::uint64_t end_{};
  std::array<LoadRegression, LAGS> regressions_{};
};

/// By how much the currents of an arm come later than its motion, as most of its joints agree [s]; 0: not by enough to
/// tell. `left`: of each joint.
double commonLag(const std::vector<std::array<double, CurrentLag::LAGS>>& left);

/// The same of one joint alone, which takes more to tell.
double ownLag(const std::array<double, CurrentLag::LAGS>& left);
}  // namespace hjt
