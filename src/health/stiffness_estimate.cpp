// SPDX-License-Identifier: BSD-3-Clause
#include "health/stiffness_estimate.hpp"

#include <cmath>

namespace hjt
{
StiffnessEstimate::StiffnessEstimate(const HealthParameters& parameters)
  : torque_span_(parameters.stiffness_torque_span)
  , forgetting_(parameters.averaging_time)
  , recent_torque_(std::llround(1e9 * parameters.averaging_time))
{
}

void StiffnessEstimate::reset() noexcept
{
  recent_torque_.reset();
  weight_ = 0.0;
  torsion_mean_ = 0.0;
  torque_mean_ = 0.0;
  torsion_square_ = 0.0;
  product_ = 0.0;
}

void StiffnessEstimate::update(std::int64_t elapsed, double torsion, double joint_torque) noexcept
{
  recent_torque_.update(elapsed, joint_torque);
  const double kept = forgetting_.kept(elapsed);
  const double time = 1e-9 * static_cast<double>(elapsed);
  weight_ = kept * weight_ + time;
  const double share = time / weight_;
  const double torsion_step = torsion - torsion_mean_;
  const double torque_step = joint_torque - torque_mean_;
  torsion_mean_ += share * torsion_step;
  torque_mean_ += share * torque_step;
  const double remaining = time * (1.0 - share);
  torsion_square_ = kept * torsion_square_ + remaining * torsion_step * torsion_step;
  product_ = kept * product_ + remaining * torsion_step * torque_step;
}

Indicator StiffnessEstimate::stiffness() const noexcept
{
  if (recent_torque_.span() < torque_span_ || !(torsion_square_ > 0.0))
  {
    return {};
  }
  return { true, product_ / torsion_square_ };
}
}  // namespace hjt
