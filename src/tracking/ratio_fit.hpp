// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "base/number_text.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Do motor and joint turn by the configured ratio? Slope of the motor's angle over the joint's by least squares of
/// their changes from row to row, in which a constant torsion has no part. Nothing allocates but the text.
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

  /// NaN: the joint moved too little to tell.
  double ratio() const noexcept
  {
    return way_ > LEAST_WAY ? products_ / squares_ : std::numeric_limits<double>::quiet_NaN();
  }

  /// As a clause; empty: they agree, or it is not known.
  std::string text() const
  {
    const double found = ratio();
    if (!std::isfinite(found) || std::abs(found / ratio_ - 1.0) < OFF)
    {
      return {};
    }
    return "its motor turns " + roundedText(found, 4) + " times as far as the joint, the configured gear's ratio is " +
           roundedText(ratio_, 4) + ": another gear, sign or unit";
  }

private:
  static constexpr double LEAST_WAY = 0.5;  // [rad]
  static constexpr double OFF = 0.005;      // beyond the effect of torsion and encoders [-]

  double ratio_;
  MotionRow last_;
  double squares_{};
  double products_{};
  double way_{};
  std::uint64_t rows_{};
};
}  // namespace hjt
