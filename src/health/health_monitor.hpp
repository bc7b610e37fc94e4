// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/health/motion_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/efficiency_estimate.hpp"
#include "health/stiffness_estimate.hpp"
#include "health/turn_window.hpp"

namespace hjt
{
/// The joint at one instant, as the model knows it: true angles, not encoder readings.
struct HealthSample
{
  std::int64_t stamp{};      ///< [ns]
  double motor_angle{};      ///< [rad]
  double motor_velocity{};   ///< [rad/s]
  double output_angle{};     ///< [rad]
  double output_velocity{};  ///< [rad/s]
  double motor_torque{};     ///< applied [N.m]
  double joint_torque{};     ///< of the mesh on the circular spline [N.m]
};

/// Watches the joint's motion step by step, in fixed memory. Allocates only at construction.
class HealthMonitor
{
public:
  HealthMonitor(const HealthParameters& parameters, const GearParameters& gear)
    : nominal_ratio_(nominalRatio(gear)), turn_(gear), stiffness_(parameters), efficiency_(parameters)
  {
  }

  void reset() noexcept
  {
    started_ = false;
    torsion_ = 0.0;
    turn_.reset();
    stiffness_.reset();
    efficiency_.reset();
  }

  /// Stamps must ascend; call `reset` before a restart.
  void update(const HealthSample& sample) noexcept
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

  MotionIndicators indicators() const noexcept
  {
    return { turn_.transmissionRatio(), torsion_, stiffness_.stiffness(), efficiency_.efficiency(),
             turn_.kinematicError() };
  }

private:
  double nominal_ratio_;
  bool started_{};
  std::int64_t stamp_{};  // of the last sample [ns]
  double torsion_{};      // [rad]
  TurnWindow turn_;
  StiffnessEstimate stiffness_;
  EfficiencyEstimate efficiency_;
};
}  // namespace hjt
