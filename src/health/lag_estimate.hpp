// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/health/indicator.hpp"
#include "health/ripple_filter.hpp"

namespace hjt
{
/// What a joint's controller cannot keep of its set points, over one window: ripple of the lag, and its lines.
///
/// Law:   r = RippleFilter of i (phi - phi_s),   R^2 = <r^2>,   A_o^2 = 4 <|c_o|^2>,   c_o = mean of r exp(j o theta)
/// where  phi, phi_s  output angle, its set point [rad];  i  ratio;  theta  motor angle [rad];  o  order
///        <>          mean over the travel;  c_o forgets in LINE_TRAVEL, so that a line counts whatever its phase does:
///                    under a load that changes its sign, and from one move to the next
/// Set points are smooth: of the motion itself nothing is left in r, which the ripple of the angle alone is full of.
class LagEstimate
{
public:
  static constexpr std::size_t LINES = 3;
  static constexpr std::array<double, LINES> ORDERS{ 1.0, 2.0, 4.0 };

  void reset() noexcept { *this = LagEstimate(); }

  /// The next window.
  void restart() noexcept
  {
    travel_ = 0.0;
    square_ = 0.0;
    lines_ = {};
  }

  /// Every sample. `lag`: at the motor [rad], NaN: no set point; `travel` of the motor, `seconds` since the last one;
  /// `moving`: it counts.
  void add(double lag, double motor_angle, double travel, double seconds, bool moving) noexcept
  {
    const bool is_first = age_ == 0.0;
    if (!std::isfinite(lag))
    {
      if (!is_first)
      {
        reset();
      }
      return;
    }
    if (is_first)
    {
      last_ = lag;
    }
    filter_.update((lag - last_) / seconds, seconds);
    last_ = lag;
    age_ += seconds;
    const double way = std::abs(travel);
    const double kept = std::exp(-way / LINE_TRAVEL);
    const double weight = moving && age_ > SETTLING_TIME ? way : 0.0;
    const double ripple = filter_.ripple();
    travel_ += weight;
    square_ += weight * ripple * ripple;
    for (std::size_t i = 0; i < LINES; ++i)
    {
      const bool seen = ORDERS[i] * way < USED_BAND * 0.5 * TWO_PI;
      const std::complex<double> turned = seen ? std::polar(ripple, ORDERS[i] * motor_angle) : 0.0;
      Line& line = lines_[i];
      line.mean = kept * line.mean + (1.0 - kept) * turned;
      line.travel += seen ? weight : 0.0;
      line.square += seen ? weight * std::norm(line.mean) : 0.0;
    }
  }

  Indicator ripple() const noexcept  ///< R [rad]
  {
    return { travel_ > LEAST_TRAVEL, std::sqrt(square_ / travel_) };
  }

  /// A_o [rad]
  Indicator line(std::size_t order) const noexcept
  {
    const Line& line = lines_[order];
    return { line.travel > SEEN_SHARE * std::max(travel_, LEAST_TRAVEL), 2.0 * std::sqrt(line.square / line.travel) };
  }

private:
  static constexpr double LINE_TRAVEL = 2.0 * TWO_PI;    // [rad]
  static constexpr double LEAST_TRAVEL = 10.0 * TWO_PI;  // in a window [rad]
  static constexpr double SETTLING_TIME = 0.2;           // of the filter [s]
  static constexpr double USED_BAND = 0.8;               // of half the samples a turn [-]
  static constexpr double SEEN_SHARE = 0.5;              // of the travel, that a line could be seen in [-]

  struct Line
  {
    std::complex<double> mean;
    double travel{};  // [rad]
    double square{};
  };

  RippleFilter filter_;
  double last_{};  // lag [rad]
  double age_{};   // [s]
  double travel_{};
  double square_{};
  std::array<Line, LINES> lines_;
};
}  // namespace hjt
