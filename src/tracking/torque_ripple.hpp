// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
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
  static constexpr std::size_t RESONANCE = 2 * LINES;  ///< where the response stands behind cos and sin of the lines
  static constexpr std::size_t VALUES = 2 * LINES + 3;
  using Orders = std::array<double, LINES>;

  TorqueRipple(const TelemetryParameters& parameters, double ratio);

  /// Ripple at the joint's angle [rad] and speed [rad/s], [N.m].
  double at(double position, double velocity) const noexcept
  {
    return std::abs(velocity) > fastest_ ? 0.0 : torque(orders_, position, velocity, values_.data());
  }

  /// Per turn of the joint: circular spline 2, flexspline 2, circular spline 4, flexspline 4.
  static Orders orders(double ratio) { return { 2.0 * ratio - 2.0, 2.0 * ratio, 4.0 * ratio - 4.0, 4.0 * ratio }; }

  /// The same of cos and sin of each line [N.m], resonance [Hz], damping [-] and lag [s], for whatever numbers a fit
  /// uses.
  template <class T>
  static T torque(const Orders& orders, double position, double velocity, const T* values)
  {
    using std::cos;
    using std::sin;
    T sum(0.0);
    const T natural = TWO_PI * values[RESONANCE];
    for (std::size_t i = 0; i < LINES; ++i)
    {
      const double w = orders[i] * velocity;
      const T c = natural * natural - w * w;
      const T b = 2.0 * values[RESONANCE + 1] * natural * w;
      const T size = -w * w / (c * c + b * b);
      const T angle = orders[i] * position - w * values[RESONANCE + 2];
      const T real = size * (c * cos(angle) + b * sin(angle));
      const T imaginary = size * (c * sin(angle) - b * cos(angle));
      sum += values[2 * i] * real + values[2 * i + 1] * imaginary;
    }
    return sum;
  }

private:
  Orders orders_;
  std::array<double, VALUES> values_;
  double fastest_;  // [rad/s]
};
}  // namespace hjt
