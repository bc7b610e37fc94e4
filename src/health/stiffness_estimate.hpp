// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "harmonic_joint_twin/health/indicator.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/forgetting.hpp"
#include "health/recent_span.hpp"

namespace hjt
{
/// Torsional stiffness of the drive: slope of the joint torque over the torsion.
///
/// Recursive least squares of  T = T_0 + K tau, each sample weighted with the time it stands for and forgotten
/// exponentially over health.averaging_time.
/// where  T    joint torque                          [N.m]
///        tau  torsion                               [rad]
///        K    torsional stiffness                   [N.m/rad]
/// Valid while the joint torque has spanned `health.stiffness_torque_span` within this window or the one before it.
class StiffnessEstimate
{
public:
  explicit StiffnessEstimate(const HealthParameters& parameters);

  void reset() noexcept;
  void update(std::int64_t elapsed, double torsion, double joint_torque) noexcept;  ///< elapsed [ns]
  Indicator stiffness() const noexcept;                                             ///< [N.m/rad]

private:
  double torque_span_;
  Forgetting forgetting_;
  RecentSpan recent_torque_;
  // Weighted sums about the running means: plain sums would lose the slope in their difference.
  double weight_{};          // [s]
  double torsion_mean_{};    // [rad]
  double torque_mean_{};     // [N.m]
  double torsion_square_{};  // [rad^2 s]
  double product_{};         // [N.m rad s]
};
}  // namespace hjt
