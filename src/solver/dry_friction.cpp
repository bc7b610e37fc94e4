// SPDX-License-Identifier: BSD-3-Clause
#include "solver/dry_friction.hpp"

#include <array>
#include <cmath>

namespace hjt
{
namespace
{
constexpr double STICK_RANGE = 1e3;  // in regularisation speeds: slower, the motor may really be at rest

/// How far to go from `v` along `change`: all the way if the function still falls there, else to where it stops
/// falling. Looks at slopes only: values near a minimum differ by less than their rounding. Leaves the gradient there
/// in `slope`.
template <class Gradient>
double searchLine(Gradient& gradient, const Eigen::Vector2d& v, const Eigen::Vector2d& change, Eigen::Vector2d& slope)
{
  constexpr int MAX_BISECTIONS = 60;
  constexpr double FLAT = 0.1;  // of the first slope
  const double first = slope.dot(change);
  slope = gradient(v + change);
  double low = 0.0;
  double high = 1.0;
  double length = 1.0;
  double here = slope.dot(change);
  for (int i = 0; i < MAX_BISECTIONS && (length < 1.0 || here > 0.0) && std::abs(here) > FLAT * std::abs(first); ++i)
  {
    (here > 0.0 ? high : low) = length;
    length = 0.5 * (low + high);
    slope = gradient(v + length * change);
    here = slope.dot(change);
  }
  return length;
}

/// Newton's step towards no slope; with the motor at rest over the output's speed alone.
Eigen::Vector2d newtonStep(const Eigen::Matrix2d& hessian, const Eigen::Vector2d& slope, bool motor_free)
{
  if (!motor_free)
  {
    return { 0.0, -slope[1] / hessian(1, 1) };
  }
  const double determinant = hessian(0, 0) * hessian(1, 1) - hessian(0, 1) * hessian(1, 0);
  return { -(hessian(1, 1) * slope[0] - hessian(0, 1) * slope[1]) / determinant,
           -(hessian(0, 0) * slope[1] - hessian(1, 0) * slope[0]) / determinant };
}

/// Friction that acts on the motor shaft alone [N.m].
double shaftStrength(const JointFriction& friction) noexcept
{
  double strength = 0.0;
  for (const FrictionTerm& term : friction.terms)
  {
    strength += term.slip[1] == 0.0 ? term.strength * std::abs(term.slip[0]) : 0.0;
  }
  return strength;
}
/// One slip s under regularised friction:  s + most r(s) = free,  r = s / sqrt(s^2 + e^2).  Leaves r in `share`.
/// False: not found in a few steps.
bool solveSlip(double free, double most, double e, double& share)
{
  constexpr int MAX_ITERATIONS = 12;
  constexpr double ENOUGH = 1e-12;
  // From the side of the law without regularisation: sliding, or standing with what is needed to hold.
  const double held = most > 0.0 ? free / most : 2.0;
  double slip = std::abs(held) < 1.0 ? e * held / std::sqrt(1.0 - held * held) : free - std::copysign(most, free);
  for (int i = 0; i < MAX_ITERATIONS; ++i)
  {
    const double root = std::sqrt(slip * slip + e * e);
    share = slip / root;
    const double excess = slip + most * share - free;
    const double change = excess / (1.0 + most * e * e / (root * root * root));
    if (std::abs(change) <= ENOUGH * (std::abs(slip) + e))
    {
      return true;
    }
    slip -= change;
  }
  return false;
}
}  // namespace

/// Slip speed at which a term is half way to full friction: what it sees at the regularising motor speed, the output
/// following or held, whichever slips more.
double DryFriction::width(const FrictionTerm& term, double velocity_ratio) const noexcept
{
  constexpr double MIN_WIDTH = 1e-100;  // of a term that nothing slips: its powers up to the third stay numbers
  return width_ * (std::abs(term.slip[0]) + std::abs(velocity_ratio * term.slip[1])) + MIN_WIDTH;
}

Eigen::Vector2d DryFriction::solve(const JointFriction& friction, double velocity_ratio,
                                   const Eigen::Vector2d& old_speeds, const Eigen::Vector2d& free_speeds,
                                   double step) const noexcept
{
  constexpr int MAX_ITERATIONS = 100;
  constexpr double ENOUGH = 1e-12;  // relative change of the speeds
  Eigen::Matrix2d hessian;
  const auto gradient = [&](const Eigen::Vector2d& v)
  {
    Eigen::Vector2d sum = inertia_.cwiseProduct(v - free_speeds) + 0.5 * step * friction.viscous * (v + old_speeds);
    hessian = 0.5 * step * friction.viscous;
    hessian.diagonal() += inertia_;
    for (const FrictionTerm& term : friction.terms)
    {
      const double e = width(term, velocity_ratio);
      const double slip = term.slip.dot(v);
      const double inverse = 1.0 / std::sqrt(slip * slip + e * e);
      sum += step * term.strength * slip * inverse * term.slip;
      hessian += step * term.strength * e * e * inverse * inverse * inverse * term.slip * term.slip.transpose();
    }
    return sum;
  };

  // Down to the minimum, or with the motor at rest to the minimum over the output's speed alone.
  const auto descend = [&](Eigen::Vector2d& v, bool motor_free)
  {
    Eigen::Vector2d slope = gradient(v);
    for (int i = 0; i < MAX_ITERATIONS; ++i)
    {
      const Eigen::Vector2d change = newtonStep(hessian, slope, motor_free);
      if (std::abs(change[0]) <= ENOUGH * (std::abs(v[0]) + width_) &&
          std::abs(change[1]) <= ENOUGH * (std::abs(v[1]) + std::abs(velocity_ratio) * width_))
      {
        break;
      }
      v += searchLine(gradient, v, change, slope) * change;
    }
    return slope;
  };

  // With the motor at rest if friction can hold it there.
  const auto rests = [&](Eigen::Vector2d& v)
  {
    v[0] = 0.0;
    const Eigen::Vector2d slope = descend(v, false);
    return std::abs(slope[0]) <= step * shaftStrength(friction);
  };
  Eigen::Vector2d v = old_speeds;
  if (old_speeds[0] == 0.0 && rests(v))
  {
    return v;
  }
  v = old_speeds;
  descend(v, true);
  if (Eigen::Vector2d at_rest = v; std::abs(v[0]) < STICK_RANGE * width_ && rests(at_rest))
  {
    return at_rest;
  }
  return v;
}

bool DryFriction::slide(const JointFriction& friction, double velocity_ratio, const Eigen::Vector2d& old_speeds,
                        const Eigen::Vector2d& free_speeds, double step, Eigen::Vector2d& speeds) const noexcept
{
  constexpr std::size_t MAX_TERMS = 9;
  const std::size_t count = friction.terms.size();
  if (count == 0 || count > MAX_TERMS)
  {
    return false;
  }
  std::array<double, MAX_TERMS> impulses;  // of the terms, each against its slip at the old speeds
  Eigen::Vector2d momentum = inertia_.cwiseProduct(free_speeds) - 0.5 * step * (friction.viscous * old_speeds);
  for (std::size_t j = 0; j < count; ++j)
  {
    const FrictionTerm& term = friction.terms[j];
    const double slip = term.slip[0] * old_speeds[0] + term.slip[1] * old_speeds[1];
    impulses[j] = std::copysign(step * term.strength, slip);
    momentum -= impulses[j] * term.slip;
  }
  const double a = inertia_[0] + 0.5 * step * friction.viscous(0, 0);
  const double b = 0.5 * step * friction.viscous(0, 1);
  const double d = inertia_[1] + 0.5 * step * friction.viscous(1, 1);
  const double inverse = 1.0 / (a * d - b * b);
  const auto answer = [&](const Eigen::Vector2d& to)
  { return Eigen::Vector2d(inverse * (d * to[0] - b * to[1]), inverse * (a * to[1] - b * to[0])); };
  Eigen::Vector2d v = answer(momentum);
  // The terms that do not go on as they slid: one of them may be the one unknown.
  const double follow = std::abs(velocity_ratio);
  std::size_t nearest = count;
  for (std::size_t j = 0; j < count; ++j)
  {
    const bool stops = !goesOn(friction.terms[j], follow, impulses[j], v);
    if (stops && nearest < count)
    {
      return false;
    }
    nearest = stops ? j : nearest;
  }
  if (nearest < count)
  {
    const FrictionTerm& term = friction.terms[nearest];
    const Eigen::Vector2d response = answer(term.slip);
    v += impulses[nearest] * response;                                   // without this term
    const double most = step * term.strength * term.slip.dot(response);  // of its slip, that this term can take
    double share = 0.0;                                                  // of its strength that it acts with
    if (!solveSlip(term.slip.dot(v), most, width(term, velocity_ratio), share))
    {
      return false;
    }
    v -= step * term.strength * share * response;
    for (std::size_t j = 0; j < count; ++j)
    {
      if (j != nearest && !goesOn(friction.terms[j], follow, impulses[j], v))
      {
        return false;
      }
    }
  }
  if (!(std::abs(v[0]) >= STICK_RANGE * width_))
  {
    return false;
  }
  speeds = v;
  return true;
}

/// Whether a term slides at these speeds in the sense of its impulse, far from standing still.
bool DryFriction::goesOn(const FrictionTerm& term, double follow, double impulse,
                         const Eigen::Vector2d& speeds) const noexcept
{
  constexpr double SLIDING = 3e4;  // slip over the regularisation's width
  const double slip = term.slip[0] * speeds[0] + term.slip[1] * speeds[1];
  return std::copysign(1.0, impulse) * slip >
         SLIDING * width_ * (std::abs(term.slip[0]) + follow * std::abs(term.slip[1]));
}

Eigen::Vector2d DryFriction::torque(const JointFriction& friction, double velocity_ratio,
                                    const Eigen::Vector2d& speeds) const noexcept
{
  Eigen::Vector2d torque = -friction.viscous * speeds;
  for (const FrictionTerm& term : friction.terms)
  {
    const double slip = term.slip.dot(speeds);
    torque -= term.strength * slip / std::hypot(slip, width(term, velocity_ratio)) * term.slip;
  }
  return torque;
}
}  // namespace hjt
