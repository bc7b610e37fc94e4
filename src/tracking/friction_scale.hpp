// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace hjt
{
/// Measured friction of a joint as a multiple of the expected one, over the last minutes of motion: slope of the
/// measured on the expected one, with its sign, beside a constant, which an offset of current or load makes. Fixed
/// memory; nothing allocates or throws.
class FrictionScale
{
public:
  void reset() noexcept { *this = FrictionScale(); }

  /// Torques at the joint, with the sign of the motion [N.m]; `step` since the last row [s].
  void add(double step, double expected, double measured, double velocity, double load) noexcept
  {
    constexpr double MEMORY = 120.0;  // of motion [s]
    const double keep = 1.0 - std::min(1.0, step / MEMORY);
    const auto sum = [&](double& total, double value) { total = keep * total + step * value; };
    sum(time_, 1.0);
    sum(x_, expected);
    sum(y_, measured);
    sum(xx_, expected * expected);
    sum(xy_, expected * measured);
    sum(yy_, measured * measured);
    sum(speed_, std::abs(velocity));
    sum(load_, std::abs(load));
  }

  /// None: not known to MAX_UNCERTAINTY.
  std::optional<double> ratio() const noexcept
  {
    constexpr double MIN_TIME = 10.0;         // [s]
    constexpr double CORRELATED = 0.5;        // rows closer than this are correlated [s]
    constexpr double MAX_UNCERTAINTY = 0.05;  // a third of what joints may differ by
    if (time_ < MIN_TIME)
    {
      return std::nullopt;
    }
    const double xx = xx_ - x_ * x_ / time_;
    if (!(xx > 1e-9 * xx_))  // one way only, at one speed
    {
      return std::nullopt;
    }
    const double xy = xy_ - x_ * y_ / time_;
    const double yy = yy_ - y_ * y_ / time_;
    const double rest = std::max(0.0, yy - xy * xy / xx);
    const double uncertainty = std::sqrt(rest / xx * CORRELATED / time_);
    return uncertainty < MAX_UNCERTAINTY ? std::make_optional(xy / xx) : std::nullopt;
  }

  double speed() const noexcept { return time_ > 0.0 ? speed_ / time_ : 0.0; }  ///< mean magnitude [rad/s]
  double load() const noexcept { return time_ > 0.0 ? load_ / time_ : 0.0; }    ///< mean magnitude [N.m]

private:
  double time_{};  // sums over time, of 1 and so on
  double x_{};
  double y_{};
  double xx_{};
  double xy_{};
  double yy_{};
  double speed_{};
  double load_{};
};
}  // namespace hjt
