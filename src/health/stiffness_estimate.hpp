// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
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
  explicit StiffnessEstimate(const HealthParameters& parameters)
    : torque_span_(parameters.stiffness_torque_span)
    , forgetting_(parameters.averaging_time)
    , recent_torque_(std::llround(1e9 * parameters.averaging_time))
  {
  }

  void reset() noexcept
  {
    recent_torque_.reset();
    weight_ = 0.0;
    torsion_mean_ = 0.0;
    torque_mean_ = 0.0;
    torsion_square_ = 0.0;
    product_ = 0.0;
  }

  /// Elapsed [ns]
  void update(std::int64_t elapsed, double torsion, double joint_torque) noexcept
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

  /// [N.m/rad]
  Indicator stiffness() const noexcept
  {
    if (recent_torque_.span() < torque_span_ || !(torsion_square_ > 0.0))
    {
      return {};
    }
    return { true, product_ / torsion_square_ };
  }

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
