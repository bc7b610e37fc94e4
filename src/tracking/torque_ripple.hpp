// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Motor torque ripple caused by the kinematic error, referred to the joint.
///
/// Each line is a torque K e, the joint's stiffness times its kinematic error, that a load standing still would feel.
/// The load is carried along: with its resonance w0 on that stiffness and its damping z the gear feels
///   T = K e (-w^2) / (w0^2 - w^2 + 2 i z w0 w),   w = order times the joint's speed,
/// nothing at rest, since the load settles. Four lines: two and four waves a turn of the motor, against the circular
/// spline, which turns with the output, and against the flexspline. Beyond the speed up to which the lines are known
/// there is none.
class TorqueRipple
{
public:
  static constexpr std::size_t LINES = 4;
  using Orders = std::array<double, LINES>;
  using Waves = std::array<std::complex<double>, LINES>;

  TorqueRipple(const TelemetryParameters& p, double ratio)
    : orders_(orders(ratio))
    , lines_{ { { p.ripple_circular_spline_2[0], p.ripple_circular_spline_2[1] },
                { p.ripple_flexspline_2[0], p.ripple_flexspline_2[1] },
                { p.ripple_circular_spline_4[0], p.ripple_circular_spline_4[1] },
                { p.ripple_flexspline_4[0], p.ripple_flexspline_4[1] } } }
    , response_{ p.ripple_resonance, p.ripple_damping, p.ripple_lag }
    , fastest_(lines_ == Waves() ? -1.0 : p.ripple_fastest)
  {
  }

  /// Ripple at the joint's angle [rad] and speed [rad/s], [N.m].
  double at(double position, double velocity) const noexcept
  {
    double sum = 0.0;
    if (std::abs(velocity) <= fastest_)
    {
      const Waves felt = waves(orders_, position, velocity, response_.data());
      for (std::size_t i = 0; i < LINES; ++i)
      {
        sum += (std::conj(lines_[i]) * felt[i]).real();
      }
    }
    return sum;
  }

  /// Per turn of the joint: circular spline 2, flexspline 2, circular spline 4, flexspline 4.
  static Orders orders(double ratio) { return { 2.0 * ratio - 2.0, 2.0 * ratio, 4.0 * ratio - 4.0, 4.0 * ratio }; }

  /// w0^2 - w^2 + 2 i z w0 w; `response`: resonance [Hz], damping [-], lag [s].
  static std::complex<double> stiffness(double w, const double* response) noexcept
  {
    const double natural = TWO_PI * response[0];
    return { natural * natural - w * w, 2.0 * response[1] * natural * w };
  }

  /// What the gear feels of each line of 1 N.m: of its cosine the real part, of its sine the imaginary part.
  static Waves waves(const Orders& orders, double position, double velocity, const double* response) noexcept
  {
    Waves turned;
    Waves felt;
    for (std::size_t i = 0; i < LINES; ++i)
    {
      const double w = orders[i] * velocity;
      const std::complex<double> inverse = std::conj(stiffness(w, response));
      // The orders of the last two are twice those of the first two.
      turned[i] = i < 2 ? std::polar(1.0, orders[i] * position - w * response[2]) : turned[i - 2] * turned[i - 2];
      felt[i] = -w * w / std::norm(inverse) * inverse * turned[i];
    }
    return felt;
  }

private:
  Orders orders_;
  Waves lines_;                     // cos + i sin [N.m]
  std::array<double, 3> response_;  // resonance [Hz], damping [-], lag [s]
  double fastest_;                  // [rad/s]; below 0: there is no line
};
}  // namespace hjt
