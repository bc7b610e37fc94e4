// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/dry_friction.hpp"

#include <cmath>

namespace hjt
{
/// Slip speed at which a term is half way to full friction: what it sees at the regularising motor speed, the output
/// following or held, whichever slips more.
double DryFriction::width(const FrictionTerm& term, double follow) const noexcept
{
  return width_ * (std::abs(term.slip[0]) + std::abs(follow * term.slip[1])) + 1e-300;
}

Eigen::Vector2d DryFriction::solve(const JointFriction& friction, double follow, const Eigen::Vector2d& old_speeds,
                                   const Eigen::Vector2d& free_speeds, double step) const noexcept
{
  constexpr int MAX_ITERATIONS = 100;
  constexpr double ENOUGH = 1e-11;  // relative change of the speeds
  const auto potential = [&](const Eigen::Vector2d& v) {
    const Eigen::Vector2d change = v - free_speeds;
    const Eigen::Vector2d mean = v + old_speeds;
    double value = 0.5 * change.dot(inertia_.cwiseProduct(change)) + 0.25 * step * mean.dot(friction.viscous * mean);
    for (const FrictionTerm& term : friction.terms)
    {
      value += step * term.strength * std::hypot(term.slip.dot(v), width(term, follow));
    }
    return value;
  };

  Eigen::Vector2d v = old_speeds;
  double value = potential(v);
  for (int i = 0; i < MAX_ITERATIONS; ++i)
  {
    Eigen::Vector2d gradient = inertia_.cwiseProduct(v - free_speeds) + 0.5 * step * friction.viscous * (v + old_speeds);
    Eigen::Matrix2d hessian = 0.5 * step * friction.viscous;
    hessian.diagonal() += inertia_;
    for (const FrictionTerm& term : friction.terms)
    {
      const double e = width(term, follow);
      const double slip = term.slip.dot(v);
      const double inverse = 1.0 / std::sqrt(slip * slip + e * e);
      gradient += step * term.strength * slip * inverse * term.slip;
      hessian += step * term.strength * e * e * inverse * inverse * inverse * term.slip * term.slip.transpose();
    }
    const double determinant = hessian(0, 0) * hessian(1, 1) - hessian(0, 1) * hessian(1, 0);
    const Eigen::Vector2d change(-(hessian(1, 1) * gradient[0] - hessian(0, 1) * gradient[1]) / determinant,
                                 -(hessian(0, 0) * gradient[1] - hessian(1, 0) * gradient[0]) / determinant);
    double length = 1.0;
    Eigen::Vector2d trial = v + change;
    double trial_value = potential(trial);
    while (trial_value > value && length > 1e-9)
    {
      length *= 0.5;
      trial = v + length * change;
      trial_value = potential(trial);
    }
    if (trial_value > value)
    {
      break;
    }
    v = trial;
    value = trial_value;
    if (length * std::abs(change[0]) <= ENOUGH * (std::abs(v[0]) + width_) &&
        length * std::abs(change[1]) <= ENOUGH * (std::abs(v[1]) + std::abs(follow) * width_))
    {
      break;
    }
  }
  return v;
}

Eigen::Vector2d DryFriction::torque(const JointFriction& friction, double follow, const Eigen::Vector2d& speeds) const
    noexcept
{
  Eigen::Vector2d torque = -friction.viscous * speeds;
  for (const FrictionTerm& term : friction.terms)
  {
    const double slip = term.slip.dot(speeds);
    torque -= term.strength * slip / std::hypot(slip, width(term, follow)) * term.slip;
  }
  return torque;
}
}  // namespace hjt
