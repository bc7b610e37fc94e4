// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace hjt
{
/// Ripple of an angle: what three filters in a row do not follow of it.
///
/// Law:   r = (s t / (1 + s t))^3 x
/// where  x  angle, given by its speed [rad];  t  TIME [s]
/// A steady acceleration has no ripple; of a line at f the share (1 + 1 / (2 pi f t)^2)^-1.5 is left, 0.9 at 30 Hz.
class RippleFilter
{
public:
  explicit RippleFilter(double speed = 0.0) : smooth_speed_(speed) {}

  /// `seconds` since the last one. Speed [rad/s].
  void update(double speed, double seconds) noexcept
  {
    const double kept = std::exp(-seconds / TIME);
    smooth_speed_ = kept * smooth_speed_ + (1.0 - kept) * speed;
    acceleration_ = kept * acceleration_ + (1.0 - kept) * (speed - smooth_speed_) / TIME;
    smooth_acceleration_ = kept * smooth_acceleration_ + (1.0 - kept) * acceleration_;
  }

  double ripple() const noexcept { return TIME * TIME * (acceleration_ - smooth_acceleration_); }  ///< [rad]

private:
  static constexpr double TIME = 0.02;  // [s]

  double smooth_speed_;           // [rad/s]
  double acceleration_{};         // [rad/s^2]
  double smooth_acceleration_{};  // [rad/s^2]
};
}  // namespace hjt
