// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/efficiency_estimate.hpp"
#include "health/indicator.hpp"
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

/// Indicators that follow from the motion; those of the single teeth come from `lobeLoads`.
struct MotionIndicators
{
  Indicator transmission_ratio;   ///< over the last motor turn [-]
  double torsion{};               ///< motor angle / nominal ratio - output angle [rad]
  Indicator torsional_stiffness;  ///< [N.m/rad]
  Indicator efficiency;           ///< [-]
  Indicator kinematic_error;      ///< peak to peak over the last motor turn [rad]
};

/// Watches the joint's motion step by step, in fixed memory. Allocates only at construction.
class HealthMonitor
{
public:
  HealthMonitor(const HealthParameters& parameters, const GearParameters& gear);

  void reset() noexcept;

  /// Stamps must ascend; `reset` before starting anew.
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
