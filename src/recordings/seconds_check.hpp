// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/number_text.hpp"
#include "health/signal_sample.hpp"

namespace hjt
{
/// Tells times that are not in seconds, by how rarely samples come and by the motor's speed, if it is recorded.
class SecondsCheck
{
public:
  void add(const SignalSample& sample)
  {
    const double step = 1e-9 * (static_cast<double>(sample.stamp) - static_cast<double>(last_.stamp));
    const double turn = sample.motor_velocity * (sample.motor_angle - last_.motor_angle);
    if (step > 0.0 && steps_++ > 0)
    {
      rare_ += step >= RARE ? 1 : 0;
      if (std::isfinite(turn))
      {
        by_angle_ += turn;
        by_speed_ += sample.motor_velocity * sample.motor_velocity * step;
      }
    }
    if (std::isfinite(sample.motor_angle))
    {
      least_ = std::min(least_, sample.motor_angle);
      most_ = std::max(most_, sample.motor_angle);
    }
    last_ = sample;
  }

  /// Empty: none.
  std::string doubt() const
  {
    constexpr double TURN = 2.0 * M_PI;  // a motor that turns by less may stand, and its speed be noise [rad]
    constexpr double FACTOR = 100.0;     // between the factors of milliseconds and of another unit of the speed
    if (2 * rare_ > steps_)
    {
      return "most samples come " + numberText(RARE) + " s apart or more";
    }
    return most_ - least_ > TURN && by_angle_ > 0.0 && by_speed_ > FACTOR * by_angle_ ?
               "by its speed and time the motor turns " + fixedText(by_speed_ / by_angle_, 0) +
                   " times as far as by its angle" :
               "";
  }

private:
  static constexpr double RARE = 0.5;  // no motion is seen in steps as long [s]

  SignalSample last_;
  std::uint64_t steps_{};
  std::uint64_t rare_{};      // steps of RARE or more
  double by_angle_{};         // sum of speed times travel [rad^2/s]
  double by_speed_{};         // and of speed squared times step
  double least_{ HUGE_VAL };  // angle of the motor [rad]
  double most_{ -HUGE_VAL };  // likewise
};
}  // namespace hjt
