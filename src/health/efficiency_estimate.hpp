// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

#include "harmonic_joint_twin/health/indicator.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/forgetting.hpp"

namespace hjt
{
/// Efficiency of the drive between the motor shaft and the circular spline.
///
/// Law:   eta = <P_j> / <P_m>  driving, both > 0;   eta = <P_m> / <P_j>  driven back by the load, both < 0
/// where  P_m  motor torque times motor speed: what the motor puts in                                 [W]
///        P_j  joint torque times output speed: what the circular spline passes on to the load        [W]
///        <>   exponential mean over `health.averaging_time`
///
/// Not valid
/// - before one window has passed,
/// - near standstill: a mean power below 0.1 W,
/// - unless power flows one way through the drive: both means of one sign, and each at least 90 % of the mean of its
///   magnitude,
/// - when the output power exceeds the input power by over 1 %: then inertia is being slowed down.
class EfficiencyEstimate
{
public:
  explicit EfficiencyEstimate(const HealthParameters& parameters)
    : window_(std::llround(1e9 * parameters.averaging_time)), forgetting_(parameters.averaging_time)
  {
  }

  void reset() noexcept
  {
    age_ = 0;
    motor_ = {};
    joint_ = {};
  }

  /// [ns], [W], [W]
  void update(std::int64_t elapsed, double motor_power, double joint_power) noexcept
  {
    age_ += elapsed;
    const double kept = forgetting_.kept(elapsed);
    motor_.update(kept, motor_power);
    joint_.update(kept, joint_power);
  }

  /// [-]
  Indicator efficiency() const noexcept
  {
    const bool driving = motor_.mean() > 0.0;
    if (age_ < window_ || !motor_.steady() || !joint_.steady() || driving != (joint_.mean() > 0.0))
    {
      return {};
    }
    const double efficiency = driving ? joint_.mean() / motor_.mean() : motor_.mean() / joint_.mean();
    if (efficiency > MAX_EFFICIENCY)
    {
      return {};
    }
    return { true, efficiency };
  }

private:
  static constexpr double MIN_POWER = 0.1;     // [W]
  static constexpr double STEADY_SHARE = 0.9;  // of the mean magnitude [-]
  static constexpr double MAX_EFFICIENCY = 1.01;

  /// Mean of a power and of its magnitude.
  class PowerMean
  {
  public:
    void update(double kept, double power) noexcept
    {
      mean_ = kept * mean_ + (1.0 - kept) * power;
      magnitude_ = kept * magnitude_ + (1.0 - kept) * std::abs(power);
    }

    bool steady() const noexcept
    {
      return std::abs(mean_) >= MIN_POWER && std::abs(mean_) >= STEADY_SHARE * magnitude_;
    }

    double mean() const noexcept { return mean_; }  // [W]

  private:
    double mean_{};       // [W]
    double magnitude_{};  // [W]
  };

  std::int64_t window_;  // [ns]
  Forgetting forgetting_;
  std::int64_t age_{};  // since start or reset [ns]
  PowerMean motor_;
  PowerMean joint_;
};
}  // namespace hjt
