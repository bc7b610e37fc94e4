// SPDX-License-Identifier: BSD-3-Clause
#include "health/efficiency_estimate.hpp"

#include <cmath>

namespace hjt
{
namespace
{
constexpr double MIN_POWER = 0.1;     // [W]
constexpr double STEADY_SHARE = 0.9;  // of the mean magnitude [-]
constexpr double MAX_EFFICIENCY = 1.01;
}  // namespace

EfficiencyEstimate::EfficiencyEstimate(const HealthParameters& parameters)
  : window_(std::llround(1e9 * parameters.averaging_time)), forgetting_(parameters.averaging_time)
{
}

void EfficiencyEstimate::reset() noexcept
{
  age_ = 0;
  motor_ = {};
  joint_ = {};
}

void EfficiencyEstimate::update(std::int64_t elapsed, double motor_power, double joint_power) noexcept
{
  age_ += elapsed;
  const double kept = forgetting_.kept(elapsed);
  motor_.update(kept, motor_power);
  joint_.update(kept, joint_power);
}

Indicator EfficiencyEstimate::efficiency() const noexcept
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

void EfficiencyEstimate::PowerMean::update(double kept, double power) noexcept
{
  mean_ = kept * mean_ + (1.0 - kept) * power;
  magnitude_ = kept * magnitude_ + (1.0 - kept) * std::abs(power);
}

bool EfficiencyEstimate::PowerMean::steady() const noexcept
{
  return std::abs(mean_) >= MIN_POWER && std::abs(mean_) >= STEADY_SHARE * magnitude_;
}
}  // namespace hjt
