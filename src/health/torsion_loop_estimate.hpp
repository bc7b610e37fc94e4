// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "harmonic_joint_twin/health/indicator.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// Torsion under a swinging load, over one window.
///
/// Law:   torsion = a - h p(T) + T / K1 + (1 / K2 - 1 / K1) sign(T) max(|T| - T1, 0),  least squares over the samples
/// where  T     joint torque [N.m];  T1  indicators.stiffness_torque
///        p     which branch of the loop: play of T of the width indicators.lost_motion_torque, -1 while T falls, +1
///              while it rises, between them where it has just turned round (Prandtl and Ishlinskii's operator)
///        2 h   lost motion [rad]
/// Stiffnesses need T to span health.stiffness_torque_span, K2 beyond T1 on either side.
/// Loop area    integral of T over the torsion from one maximum of T to the next, mean of the loops that closed [J]
class TorsionLoopEstimate
{
public:
  TorsionLoopEstimate(const HealthParameters& health, const IndicatorParameters& parameters)
    : first_torque_(parameters.stiffness_torque)
    , torque_span_(health.stiffness_torque_span)
    , play_(parameters.lost_motion_torque)
    , regression_(COLUMNS, 1)
  {
    reset();
  }

  void reset() noexcept
  {
    regression_.reset();
    lowest_ = 0.0;
    highest_ = 0.0;
    stiffness_ = {};
    second_stiffness_ = {};
    lost_motion_ = {};
    started_ = false;
    area_ = 0.0;
    loops_ = 0;
  }

  /// Every sample in its turn; `steady`: the torsion is that of the joint torque, not of inertia.
  void add(double torsion, double joint_torque, bool steady) noexcept
  {
    followTorque(torsion, joint_torque);
    if (steady)
    {
      const bool first = regression_.rows() == 0.0;
      lowest_ = first ? joint_torque : std::min(lowest_, joint_torque);
      highest_ = first ? joint_torque : std::max(highest_, joint_torque);
      const double branch = (joint_torque - centre_) / (0.5 * play_);
      const double beyond = std::copysign(std::max(std::abs(joint_torque) - first_torque_, 0.0), joint_torque);
      regression_.add(Eigen::Vector4d(1.0, joint_torque, branch, beyond), Eigen::Matrix<double, 1, 1>(torsion));
    }
  }

  void fit() noexcept
  {
    stiffness_ = {};
    second_stiffness_ = {};
    lost_motion_ = {};
    if (highest_ - lowest_ < torque_span_ || !regression_.fit(COLUMNS))
    {
      return;
    }
    const double slope = regression_.coefficient(SLOPE, 0);
    if (!(slope > 0.0) || regression_.standardError(SLOPE, 0) > MAX_ERROR * slope)
    {
      return;
    }
    stiffness_ = { true, 1.0 / slope };
    const double second = slope + regression_.coefficient(BEYOND, 0);
    if (std::max(highest_, -lowest_) - first_torque_ > torque_span_ && second > 0.0)
    {
      second_stiffness_ = { true, 1.0 / second };
    }
    if (regression_.inflation(BRANCH) < MAX_INFLATION)
    {
      lost_motion_ = { true, -2.0 * regression_.coefficient(BRANCH, 0) };
    }
  }

  Indicator stiffness() const noexcept { return stiffness_; }               ///< K1 [N.m/rad]
  Indicator secondStiffness() const noexcept { return second_stiffness_; }  ///< K2 [N.m/rad]
  Indicator lostMotion() const noexcept { return lost_motion_; }            ///< [rad]

  /// [J]
  Indicator loopArea() const noexcept { return loops_ > 0 ? Indicator{ true, area_ / loops_ } : Indicator{}; }

private:
  static constexpr int COLUMNS = 4;
  static constexpr int SLOPE = 1;                // column of the torque
  static constexpr int BRANCH = 2;               // of the play
  static constexpr int BEYOND = 3;               // of the torque beyond T1
  static constexpr double MAX_ERROR = 0.1;       // of the slope, standard, as a share of it [-]
  static constexpr double MAX_INFLATION = 10.0;  // of the branch's variance: both branches at like torques [-]

  void followTorque(double torsion, double joint_torque) noexcept
  {
    if (!started_)
    {
      started_ = true;
      rising_ = true;
      past_first_ = false;
      extreme_ = joint_torque;
      work_ = 0.0;
    }
    else
    {
      work_ += 0.5 * (joint_torque + torque_) * (torsion - torsion_);
    }
    torsion_ = torsion;
    torque_ = joint_torque;
    centre_ = std::clamp(centre_, joint_torque - 0.5 * play_, joint_torque + 0.5 * play_);
    extreme_ = rising_ ? std::max(extreme_, joint_torque) : std::min(extreme_, joint_torque);
    if (std::abs(joint_torque - extreme_) > play_)
    {
      // Seen as late after each maximum, so that what a loop is short of at its start it has more at its end.
      if (rising_)
      {
        area_ += past_first_ ? work_ : 0.0;
        loops_ += past_first_ ? 1 : 0;
        past_first_ = true;
        work_ = 0.0;
      }
      rising_ = !rising_;
      extreme_ = joint_torque;
    }
  }

  double first_torque_;  // T1 [N.m]
  double torque_span_;
  double play_;  // width of the play [N.m]
  RunningRegression regression_;
  double lowest_{};   // joint torque in the regression [N.m]
  double highest_{};  // [N.m]
  Indicator stiffness_;
  Indicator second_stiffness_;
  Indicator lost_motion_;

  double centre_{};  // of the play [N.m]
  bool started_{};
  bool rising_{};
  double extreme_{};   // of the torque since it turned round last [N.m]
  double torsion_{};   // of the last sample [rad]
  double torque_{};    // of the last sample [N.m]
  double work_{};      // since the last maximum was seen [J]
  bool past_first_{};  // a maximum has been seen: the loop running now is a whole one
  double area_{};      // of the loops that closed [J]
  int loops_{};
};
}  // namespace hjt
