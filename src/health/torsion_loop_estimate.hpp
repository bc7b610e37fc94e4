// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "harmonic_joint_twin/health/indicator.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "health/running_regression.hpp"

namespace hjt
{
/// Torsion under a swinging load, over one window.
///
/// Stiffness    1 / slope of  torsion = a + h sign(speed) + T / K1  by least squares over samples with
///              |T| < indicators.stiffness_torque; needs T to span health.stiffness_torque_span there
/// Lost motion  mean of torsion - T / K1 while T falls less that while it rises, |T| < indicators.lost_motion_torque
/// Loop area    integral of T over the torsion from one maximum of T to the next, mean of the loops that closed [J]
/// where        T  joint torque [N.m]; it turns round where it has come back by indicators.lost_motion_torque
class TorsionLoopEstimate
{
public:
  TorsionLoopEstimate(const HealthParameters& health, const IndicatorParameters& parameters)
    : torque_range_(parameters.stiffness_torque)
    , torque_span_(health.stiffness_torque_span)
    , lost_motion_torque_(parameters.lost_motion_torque)
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
    lost_motion_ = {};
    branches_ = {};
    started_ = false;
    area_ = 0.0;
    loops_ = 0;
  }

  void add(double torsion, double joint_torque, double direction) noexcept
  {
    followTorque(torsion, joint_torque);
    if (std::abs(joint_torque) < torque_range_)
    {
      const bool first = regression_.weight() == 0.0;
      lowest_ = first ? joint_torque : std::min(lowest_, joint_torque);
      highest_ = first ? joint_torque : std::max(highest_, joint_torque);
      regression_.add(Eigen::Vector3d(1.0, direction, joint_torque), Eigen::Matrix<double, 1, 1>(torsion));
    }
  }

  void fit() noexcept
  {
    stiffness_ = {};
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
    const Branch& rising = branches_[RISING];
    const Branch& falling = branches_[FALLING];
    if (rising.count > 0.0 && falling.count > 0.0)
    {
      const auto offset = [slope](const Branch& branch)
      { return (branch.torsion - slope * branch.torque) / branch.count; };
      lost_motion_ = { true, offset(falling) - offset(rising) };
    }
  }

  Indicator stiffness() const noexcept { return stiffness_; }     ///< K1 [N.m/rad]
  Indicator lostMotion() const noexcept { return lost_motion_; }  ///< [rad]

  /// [J]
  Indicator loopArea() const noexcept { return loops_ > 0 ? Indicator{ true, area_ / loops_ } : Indicator{}; }

private:
  static constexpr int COLUMNS = 3;
  static constexpr int SLOPE = 2;           // column of the torque
  static constexpr double MAX_ERROR = 0.1;  // of the slope, standard, as a share of it [-]
  static constexpr std::size_t RISING = 0;
  static constexpr std::size_t FALLING = 1;

  struct Branch
  {
    double count{};
    double torsion{};  // sum [rad]
    double torque{};   // sum [N.m]
  };

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
    extreme_ = rising_ ? std::max(extreme_, joint_torque) : std::min(extreme_, joint_torque);
    if (std::abs(joint_torque - extreme_) > lost_motion_torque_)
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
    if (past_first_ && std::abs(joint_torque) < lost_motion_torque_)
    {
      Branch& branch = branches_[rising_ ? RISING : FALLING];
      branch.count += 1.0;
      branch.torsion += torsion;
      branch.torque += joint_torque;
    }
  }

  double torque_range_;
  double torque_span_;
  double lost_motion_torque_;
  RunningRegression regression_;
  double lowest_{};   // joint torque in the regression [N.m]
  double highest_{};  // [N.m]
  Indicator stiffness_;
  Indicator lost_motion_;
  std::array<Branch, 2> branches_;  // rising, falling

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
