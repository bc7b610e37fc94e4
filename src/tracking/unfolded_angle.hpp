// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "gear/angle.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Angles of a joint that a source gives folded into one turn, made continuous again. Nothing allocates.
///
/// A step within MotionDifferentiator::MAX_GAP that is nearer to one turn than NEAR is a fold: no joint turns as far
/// in that time. After a gap the turns stay as they are.
class UnfoldedAngle
{
public:
  /// `angle` [rad] at `time` [s].
  double take(double time, double angle) noexcept
  {
    const double step = angle - last_;
    const double turns = std::round(step / (TWO_PI));
    const double passed = time - time_;
    if (std::abs(turns) == 1.0 && passed > 0.0 && passed <= MotionDifferentiator::MAX_GAP &&
        std::abs(step - TWO_PI * turns) < NEAR)
    {
      offset_ -= TWO_PI * turns;
      ++folds_;
    }
    last_ = angle;
    time_ = time;
    return offset_ == 0.0 ? angle : angle + offset_;
  }

  std::uint64_t folds() const noexcept { return folds_; }
  void reset() noexcept { *this = UnfoldedAngle(); }

private:
  static constexpr double NEAR = 1.0;  // [rad]

  double last_{ std::numeric_limits<double>::quiet_NaN() };
  double time_{ std::numeric_limits<double>::quiet_NaN() };
  double offset_{};
  std::uint64_t folds_{};
};
}  // namespace hjt
