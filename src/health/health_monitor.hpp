// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/health/motion_indicators.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// The torsion over the last turn of the motor: transmission ratio and kinematic error.
///
/// The torsion is kept at marks evenly spaced in the motor angle, 16 to a tooth of the flexspline (the error of a sound
/// gear repeats every tooth pitch), interpolated linearly between the two samples around each mark. The store holds
/// one turn, whatever the speed.
///
/// Coming back to the mark before the last one is a reversal and empties the store; less (up to 2 mrad with 200 teeth)
/// is a tremor about the same place and is not. Both indicators are valid once the store is full: after one turn and
/// one or two marks of travel in one direction since start or reversal.
class TurnWindow
{
public:
  explicit TurnWindow(const GearParameters& gear);

  void reset() noexcept;

  /// `torsion`: motor angle / nominal ratio - output angle [rad]. An angle beyond 1e15 marks, or none, empties the
  /// store.
  void update(double motor_angle, double torsion) noexcept;

  /// Motor travel over output travel, from the instant the motor stood exactly one turn behind until now [-].
  /// Also not valid if the output made no way: less than a millionth of the nominal.
  Indicator transmissionRatio() const noexcept;

  /// Peak to peak of the torsion at the marks of the last turn, after subtracting the straight line through the two
  /// ends of that turn [rad]. The line takes out a torsion that grows with a changing load, and, as the turn's ends
  /// are alike, leaves every error of a whole number of cycles a turn untouched; a line by least squares would not.
  Indicator kinematicError() const noexcept;

private:
  bool full() const noexcept { return count_ == torsions_.size(); }
  void keep(double place, double slope, std::int64_t marks) noexcept;
  double torsionAt(Eigen::Index marks_back) const noexcept;

  double nominal_ratio_;
  std::int64_t marks_per_turn_;
  double marks_per_radian_;

  // Places are motor angles in marks, mirrored so that they grow in the direction of travel.
  bool started_{};
  int direction_{ 1 };
  double place_{};              // of the last sample
  double torsion_{};            // of the last sample
  std::int64_t newest_mark_{};  // last mark reached
  Eigen::VectorXd torsions_;    // ring of one turn and one mark, both ends included
  Eigen::Index newest_{};
  Eigen::Index count_{};
};

/// Exponential forgetting in time: what is `window` old counts 1/e of what is new.
class Forgetting
{
public:
  /// `window`: time constant [s].
  explicit Forgetting(double window) : window_(window) {}

  /// Share that is kept over `elapsed` [ns]. Steps are nearly always alike, so the last one is remembered.
  double kept(std::int64_t elapsed) noexcept
  {
    if (elapsed != elapsed_)
    {
      elapsed_ = elapsed;
      kept_ = std::exp(-1e-9 * static_cast<double>(elapsed) / window_);
    }
    return kept_;
  }

private:
  double window_;
  std::int64_t elapsed_{};
  double kept_{ 1.0 };
};

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
  explicit EfficiencyEstimate(const HealthParameters& parameters)
    : window_(std::llround(1e9 * parameters.averaging_time)), forgetting_(parameters.averaging_time)
  {
  }

  void reset() noexcept
  {
    age_ = 0;
    motor_ = {};
    joint_ = {};
  }

  /// [ns], [W], [W]
  void update(std::int64_t elapsed, double motor_power, double joint_power) noexcept
  {
    age_ += elapsed;
    const double kept = forgetting_.kept(elapsed);
    motor_.update(kept, motor_power);
    joint_.update(kept, joint_power);
  }

  /// [-]
  Indicator efficiency() const noexcept
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

private:
  static constexpr double MIN_POWER = 0.1;     // [W]
  static constexpr double STEADY_SHARE = 0.9;  // of the mean magnitude [-]
  static constexpr double MAX_EFFICIENCY = 1.01;

  /// Mean of a power and of its magnitude.
  class PowerMean
  {
  public:
    void update(double kept, double power) noexcept
    {
      mean_ = kept * mean_ + (1.0 - kept) * power;
      magnitude_ = kept * magnitude_ + (1.0 - kept) * std::abs(power);
    }

    bool steady() const noexcept
    {
      return std::abs(mean_) >= MIN_POWER && std::abs(mean_) >= STEADY_SHARE * magnitude_;
    }

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
