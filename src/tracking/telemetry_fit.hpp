// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "base/number_text.hpp"
#include "base/statistics.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Checks whether motor and joint turn by the configured ratio. The found ratio is the slope of motor angle over joint
/// angle, by least squares from changes between rows, so that a constant torsion has no effect. Only text() allocates.
class RatioFit
{
public:
  explicit RatioFit(double ratio = 1.0) : ratio_(ratio) {}

  void reset() noexcept { *this = RatioFit(ratio_); }

  void add(const MotionRow& row) noexcept
  {
    if (!std::isfinite(row.motor_angle))
    {
      return;
    }
    const double change = row.position - last_.position;
    if (rows_++ > 0 && row.time > last_.time && row.time - last_.time <= MotionDifferentiator::MAX_GAP)
    {
      squares_ += change * change;
      products_ += change * (row.motor_angle - last_.motor_angle);
      way_ += std::abs(change);
    }
    last_ = row;
  }

  /// The found ratio [-]; NaN: the joint moved too little.
  double ratio() const noexcept
  {
    return way_ > LEAST_WAY ? products_ / squares_ : std::numeric_limits<double>::quiet_NaN();
  }

  /// Clause that says that the ratio is wrong; empty: the ratio is as configured, or not known.
  std::string text() const
  {
    const double found = ratio();
    if (!std::isfinite(found) || std::abs(found / ratio_ - 1.0) < OFF)
    {
      return {};
    }
    return "its motor turns " + roundedText(found, 4) + " times as far as the joint, but the configured gear has the " +
           "ratio " + roundedText(ratio_, 4) + ": the gear, a sign or a unit is not as configured";
  }

private:
  static constexpr double LEAST_WAY = 0.5;  // least distance that a joint must move for a result [rad]
  static constexpr double OFF = 0.005;      // least relative deviation that counts; torsion and encoders cause less [-]

  double ratio_;
  MotionRow last_;
  double squares_{};
  double products_{};
  double way_{};
  std::uint64_t rows_{};
};

/// A factor with its uncertainty.
struct FittedFactor
{
  double value{ std::numeric_limits<double>::quiet_NaN() };  ///< the factor; NaN: not known
  double uncertainty{};                                      ///< standard deviation of the factor
};

/// Checks whether the recorded velocities of a joint agree with the slopes of its angles over the times of the stamps.
///
/// The class averages velocities and slopes over pieces of 0.1 s. The factor is the weighted median of slope / velocity
/// over windows of 0.8 s with motion, so that single wrong rows do not count. The lag of the velocity follows from
/// least squares, to first order. The last KEPT windows count for the factor, about the last MEMORY pieces with
/// acceleration for the lag. Nothing allocates.
class TimeFit
{
public:
  static constexpr double PIECE = 0.1;  ///< length of a piece [s]

  void reset() noexcept { *this = TimeFit(); }

  /// Adds a row. `velocity`: recorded velocity; NaN: none [rad/s].
  void add(double time, double position, double velocity) noexcept
  {
    const double step = time - time_;
    if (step >= 0.0 && step < MotionDifferentiator::MIN_STEP)
    {
      return;
    }
    if (step < 0.0 || step > MotionDifferentiator::MAX_GAP || !std::isfinite(velocity))
    {
      pieces_ = 0;
      piece_ = {};
    }
    else
    {
      piece_.seconds += step;
      piece_.angle += position - position_;
      piece_.integral += 0.5 * (velocity + velocity_) * step;
      if (piece_.seconds > PIECE - MotionDifferentiator::MIN_STEP)
      {
        close();
      }
    }
    time_ = time;
    position_ = position;
    velocity_ = velocity;
    has_velocity_ = has_velocity_ || std::isfinite(velocity);
  }

  /// Change of the angles over the integral of the velocities [-]; 1: both agree; infinite: the velocities are zero.
  FittedFactor factor() const noexcept
  {
    const std::size_t count = std::min<std::uint64_t>(windows_, KEPT);
    if (count < MIN_WINDOWS)
    {
      return {};
    }
    std::array<std::size_t, KEPT> order;
    std::array<double, KEPT> values;
    double weight = 0.0;
    for (std::size_t i = 0; i < count; ++i)
    {
      order[i] = i;
      values[i] = kept_[i].integral != 0.0 ? kept_[i].angle / kept_[i].integral : HUGE_VAL;
      weight += kept_[i].weight();
    }
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(count);
    std::sort(order.begin(), end, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    double sum = 0.0;
    const auto middle = std::find_if(order.begin(), end,
                                     [&](std::size_t i)
                                     {
                                       sum += kept_[i].weight();
                                       return sum >= 0.5 * weight;
                                     });
    FittedFactor factor;
    factor.value = values[*middle];
    if (!std::isfinite(factor.value))
    {
      return factor;
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      values[i] = std::abs(values[i] - factor.value);
    }
    const double typical = upperMedian(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
    factor.uncertainty = typical / NORMAL_MEDIAN / std::sqrt(static_cast<double>(count));
    return factor;
  }

  /// Lag of the recorded velocity behind the slope of the angles [s]. The lag has a meaning only if factor() is near 1.
  FittedFactor lag() const noexcept
  {
    FittedFactor lag;
    if (accelerated_ >= MIN_ACCELERATED)
    {
      lag.value = -products_ / accelerations_;
      const double rest = std::max(0.0, differences_ + products_ * lag.value);
      lag.uncertainty = std::sqrt(rest / accelerations_ / accelerated_);
    }
    return lag;
  }

  bool hasVelocity() const noexcept { return has_velocity_; }

private:
  static constexpr int PIECES = 8;                   // number of pieces in a window
  static constexpr std::size_t MIN_WINDOWS = 6;      // least number of windows for a median
  static constexpr std::size_t KEPT = 256;           // number of kept windows, 200 s of motion
  static constexpr double MEMORY = 2000.0;           // number of accelerated pieces over which the lag is averaged
  static constexpr double MIN_ACCELERATED = 20.0;    // least number of accelerated pieces for a lag
  static constexpr double LEAST_ACCELERATION = 0.1;  // least acceleration of an accelerated piece [rad/s^2]

  struct Piece
  {
    double seconds{};
    double angle{};     // change of the angle [rad]
    double integral{};  // integral of the velocity [rad]

    double slope() const { return angle / seconds; }
    double velocity() const { return integral / seconds; }
    double weight() const { return std::max(std::abs(angle), std::abs(integral)); }
  };

  void close() noexcept
  {
    last_[0] = last_[1];
    last_[1] = last_[2];
    last_[2] = piece_;
    window_ = pieces_ % PIECES == 0 ? Piece() : window_;
    window_.seconds += piece_.seconds;
    window_.angle += piece_.angle;
    window_.integral += piece_.integral;
    ++pieces_;
    piece_ = {};
    if (pieces_ % PIECES == 0 && window_.weight() > MotionDifferentiator::SLIDING * window_.seconds)
    {
      kept_[windows_++ % KEPT] = window_;
    }
    if (pieces_ < 3)
    {
      return;
    }
    const double acceleration =
        (last_[2].slope() - last_[0].slope()) / (0.5 * last_[0].seconds + last_[1].seconds + 0.5 * last_[2].seconds);
    if (std::abs(acceleration) > LEAST_ACCELERATION)
    {
      const double difference = last_[1].velocity() - last_[1].slope();
      const double kept = 1.0 - 1.0 / MEMORY;
      accelerations_ = kept * accelerations_ + acceleration * acceleration;
      products_ = kept * products_ + acceleration * difference;
      differences_ = kept * differences_ + difference * difference;
      accelerated_ = kept * accelerated_ + 1.0;
    }
  }

  double time_{ -std::numeric_limits<double>::infinity() };
  double position_{};
  double velocity_{};
  bool has_velocity_{};
  Piece piece_;
  std::uint64_t pieces_{};  // number of pieces since the last gap
  std::array<Piece, 3> last_;
  Piece window_;
  std::array<Piece, KEPT> kept_;
  std::uint64_t windows_{};
  double accelerations_{};  // sum of the squared accelerations [rad^2/s^4]
  double products_{};
  double differences_{};
  double accelerated_{};
};
}  // namespace hjt
