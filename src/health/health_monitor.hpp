// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/health/indicator.hpp"
#include "harmonic_joint_twin/health/motion_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/efficiency_estimate.hpp"
#include "health/forgetting.hpp"
#include "health/turn_window.hpp"

namespace hjt
{
/// How far a quantity has varied lately: over the running window of fixed length and the one before it.
class RecentSpan
{
public:
  /// `window`: length of one window [ns].
  explicit RecentSpan(std::int64_t window) : window_(window) {}

  void reset() noexcept { *this = RecentSpan(window_); }

  void update(std::int64_t elapsed, double value) noexcept
  {
    age_ += elapsed;
    if (!started_)
    {
      started_ = true;
      age_ = 0;
      running_ = { value, value };
      before_ = running_;
    }
    else if (age_ >= window_)
    {
      age_ = 0;
      before_ = running_;
      running_ = { value, value };
    }
    running_ = { std::min(running_.lowest, value), std::max(running_.highest, value) };
  }

  double span() const noexcept
  {
    return std::max(running_.highest, before_.highest) - std::min(running_.lowest, before_.lowest);
  }

private:
  struct Extremes
  {
    double lowest{};
    double highest{};
  };

  std::int64_t window_;
  std::int64_t age_{};  // of the running window [ns]
  bool started_{};
  Extremes running_;
  Extremes before_;
};

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
