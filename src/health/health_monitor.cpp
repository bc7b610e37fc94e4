// SPDX-License-Identifier: BSD-3-Clause
#include "health/health_monitor.hpp"

#include "gear/ratio.hpp"

namespace hjt
{
HealthMonitor::HealthMonitor(const HealthParameters& parameters, const GearParameters& gear)
  : nominal_ratio_(nominalRatio(gear)), turn_(gear), stiffness_(parameters), efficiency_(parameters)
{
}

void HealthMonitor::reset() noexcept
{
  started_ = false;
  torsion_ = 0.0;
  turn_.reset();
  stiffness_.reset();
  efficiency_.reset();
}

void HealthMonitor::update(const HealthSample& sample) noexcept
{
  torsion_ = sample.motor_angle / nominal_ratio_ - sample.output_angle;
  turn_.update(sample.motor_angle, torsion_);
  // The first sample stands for no time yet.
  if (started_)
  {
    const std::int64_t elapsed = sample.stamp - stamp_;
    stiffness_.update(elapsed, torsion_, sample.joint_torque);
    efficiency_.update(elapsed, sample.motor_torque * sample.motor_velocity,
                       sample.joint_torque * sample.output_velocity);
  }
  started_ = true;
  stamp_ = sample.stamp;
}

MotionIndicators HealthMonitor::indicators() const noexcept
{
  return { turn_.transmissionRatio(), torsion_, stiffness_.stiffness(), efficiency_.efficiency(),
           turn_.kinematicError() };
}
}  // namespace hjt
