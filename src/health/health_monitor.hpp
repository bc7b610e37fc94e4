// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

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
  HealthMonitor(const HealthParameters& parameters, const GearParameters& gear);

  void reset() noexcept;

  /// Stamps must ascend; call `reset` before a restart.
  void update(const HealthSample& sample) noexcept;

  MotionIndicators indicators() const noexcept;

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
