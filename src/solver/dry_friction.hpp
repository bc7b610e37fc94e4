// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elements/friction_laws.hpp"

namespace hjt
{
/// Speeds of motor and output after a time step and half way through it [rad/s].
struct KickedSpeeds
{
  Eigen::Vector2d after;
  Eigen::Vector2d halfway;
  bool solved{ true };  ///< false: friction was not; the speeds are anything
};

/// Speeds after a time step with all friction taken implicitly: the minimum of
///
///   1/2 (v - v_free)^T M (v - v_free) + h/4 (v + v_old)^T D (v + v_old) + h sum_j c_j sqrt((a_j v)^2 + e_j^2)
///
/// Convex, so it has one solution whatever the step: friction sticks, slides and reverses without a mode switch.
/// e_j regularises the kink at the motor speed `stiction_velocity`; Newton with line search, 2 x 2. A motor that
/// friction on its shaft can hold comes to rest exactly.
class DryFriction
{
public:
  DryFriction(const Eigen::Vector2d& inertia, double stiction_velocity) : inertia_(inertia), width_(stiction_velocity)
  {
  }

  /// The same with another inertia of the motor [kg.m^2].
  DryFriction withMotor(double inertia) const { return { Eigen::Vector2d(inertia, inertia_[1]), width_ }; }

  void setOutput(double inertia) noexcept { inertia_[1] = inertia; }  ///< another inertia of the output [kg.m^2]

  /// `velocity_ratio`: output speed over motor speed in plain running; scales the regularisation of slips at the
  /// output. False: the minimum was not found; `speeds` are anything.
  [[nodiscard]] bool solve(const JointFriction& friction, double velocity_ratio, const Eigen::Vector2d& old_speeds,
                           const Eigen::Vector2d& free_speeds, double step, Eigen::Vector2d& speeds) const noexcept;

  /// The same in parts where a term that moves comes to rest within the step: up to there it slides, and those that do
  /// not move at the old speeds stick. `free_momentum`: M v_free [N.m.s]; `sticking`: room.
  KickedSpeeds stopOrSlide(const JointFriction& friction, double velocity_ratio, const Eigen::Vector2d& old_speeds,
                           const Eigen::Vector2d& free_momentum, double step, JointFriction& sticking) const noexcept;

  /// The same minimum where every term, or every one but one that stood, slides as it did at the old speeds, far from
  /// standing still: linear but for one unknown. False, and nothing done, elsewhere, at rest above all. Differs from
  /// `solve` by the tails of the regularisation, less than 1e-9 of the friction. `free_momentum`: M v_free [N.m.s].
  bool slide(const JointFriction& friction, double velocity_ratio, const Eigen::Vector2d& old_speeds,
             const Eigen::Vector2d& free_momentum, double step, Eigen::Vector2d& speeds) const noexcept;

  /// Friction torque on motor and output at given speeds, explicit [N.m].
  Eigen::Vector2d torque(const JointFriction& friction, double velocity_ratio,
                         const Eigen::Vector2d& speeds) const noexcept;

  const Eigen::Vector2d& inertia() const noexcept { return inertia_; }  ///< [kg.m^2]

private:
  /// Derivatives of sum_j c_j sqrt((a_j v)^2 + e_j^2) by the speeds.
  struct Slopes
  {
    Eigen::Vector2d first;
    Eigen::Matrix2d second;
  };

  double width(const FrictionTerm& term, double velocity_ratio) const noexcept;
  Slopes slopes(const FrictionTerms& terms, double follow, const Eigen::Vector2d& v) const noexcept;
  bool anyStops(const FrictionTerms& terms, double follow, const Eigen::Vector2d& before,
                const Eigen::Vector2d& after) const noexcept;

  Eigen::Vector2d inertia_;
  double width_;
};
}  // namespace hjt
