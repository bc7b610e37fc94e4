// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

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
  TorsionLoopEstimate(const HealthParameters& health, const IndicatorParameters& parameters);

  void reset() noexcept;
  void add(double torsion, double joint_torque, double direction) noexcept;
  void fit() noexcept;

  Indicator stiffness() const noexcept { return stiffness_; }     ///< K1 [N.m/rad]
  Indicator lostMotion() const noexcept { return lost_motion_; }  ///< [rad]
  Indicator loopArea() const noexcept;                            ///< [J]

private:
  struct Branch
  {
    double count{};
    double torsion{};  // sum [rad]
    double torque{};   // sum [N.m]
  };

  void followTorque(double torsion, double joint_torque) noexcept;

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
