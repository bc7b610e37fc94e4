// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elements/friction_laws.hpp"

namespace hjt
{
/// Speeds of motor and output at the end and in the middle of a time step [rad/s].
struct KickedSpeeds
{
  Eigen::Vector2d after;
  Eigen::Vector2d halfway;
  bool solved{ true };  ///< false: the friction problem was not solved and the speeds are invalid
};

/// Solver for the speeds v of motor and output after a time step with implicit friction. These speeds minimise
///
///   1/2 (v - v_free)^T M (v - v_free) + h/4 (v + v_old)^T D (v + v_old) + h sum_j c_j sqrt((a_j v)^2 + e_j^2)
/// where  v_free  speeds without friction, v_old  speeds before the step [rad/s]; h  length of the step [s]
///        M  inertias, D  viscous matrix; c_j  strength and a_j  slip of dry term j; e_j  width of its regularisation
///
/// The function is convex and has one minimum, so friction sticks, slides and reverses without a change of mode. e_j,
/// the slip at the motor speed `stiction_velocity`, rounds the kink of the friction at rest. The method is Newton's
/// with line search. If the friction on the motor's shaft can hold the motor, the motor's speed becomes exactly zero.
class DryFriction
{
public:
  DryFriction(const Eigen::Vector2d& inertia, double stiction_velocity) : inertia_(inertia), width_(stiction_velocity)
  {
  }

  /// Copy of this solver with `inertia` as the inertia of the motor [kg.m^2].
  DryFriction withMotor(double inertia) const { return { Eigen::Vector2d(inertia, inertia_[1]), width_ }; }

  void setOutput(double inertia) noexcept { inertia_[1] = inertia; }  ///< sets the inertia of the output [kg.m^2]

  /// Computes the `speeds` after the step. `velocity_ratio`: output speed over motor speed while the drive runs, which
  /// scales the regularisation of slips at the output. @returns false, with invalid `speeds`, if there is no solution.
  [[nodiscard]] bool solve(const JointFriction& friction, double velocity_ratio, const Eigen::Vector2d& old_speeds,
                           const Eigen::Vector2d& free_speeds, double step, Eigen::Vector2d& speeds) const noexcept;

  /// Computes the speeds like `solve`. If a sliding term stops within the step, the step is divided at this instant.
  /// Terms at rest stick until this instant. `free_momentum`: M v_free [N.m.s]; `sticking`: working memory.
  KickedSpeeds stopOrSlide(const JointFriction& friction, double velocity_ratio, const Eigen::Vector2d& old_speeds,
                           const Eigen::Vector2d& free_momentum, double step, JointFriction& sticking) const noexcept;

  /// Computes the speeds like `solve` if all terms, or all except one, slide far from rest in the same direction as
  /// before the step. The problem is then linear with at most one unknown. @returns false and does nothing in other
  /// cases, for example at rest. The result differs from that of `solve` by less than 1e-9 of the friction, because
  /// `slide` neglects the regularisation of sliding terms. `free_momentum`: M v_free [N.m.s].
  bool slide(const JointFriction& friction, double velocity_ratio, const Eigen::Vector2d& old_speeds,
             const Eigen::Vector2d& free_momentum, double step, Eigen::Vector2d& speeds) const noexcept;

  /// Friction torque on motor and output for given speeds [N.m].
  Eigen::Vector2d torque(const JointFriction& friction, double velocity_ratio,
                         const Eigen::Vector2d& speeds) const noexcept;

  const Eigen::Vector2d& inertia() const noexcept { return inertia_; }  ///< inertia of motor and output [kg.m^2]

private:
  /// First and second derivatives of sum_j c_j sqrt((a_j v)^2 + e_j^2) by the speeds v.
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
