// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
  explicit EfficiencyEstimate(const HealthParameters& parameters);

  void reset() noexcept;
  void update(std::int64_t elapsed, double motor_power, double joint_power) noexcept;  ///< [ns], [W], [W]
  Indicator efficiency() const noexcept;                                               ///< [-]

private:
  /// Mean of a power and of its magnitude.
  class PowerMean
  {
  public:
    void update(double kept, double power) noexcept;
    bool steady() const noexcept;
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
