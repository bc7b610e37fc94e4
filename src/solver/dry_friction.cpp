// SPDX-License-Identifier: BSD-3-Clause
#include "solver/dry_friction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gear/vector_loops.hpp"

namespace hjt
{
namespace
{
// motor speed over solver.stiction_velocity, below which the motor can be exactly at rest [-]
constexpr double STICK_RANGE = 1e3;
constexpr double SLIDING = 3e4;  // slip over the width of the regularisation, above which a term is far from rest [-]
// slip over the width of the regularisation, above which a term slides: it has its full friction to 6e-4 [-]
constexpr double MOVING = 30.0;
constexpr double MIN_WIDTH = 1e-100;  // width for a term without slip: its square and its inverse are finite

/// Length of the step from `v` along `change`: 1 if the function still falls at the end of `change`, else a length at
/// which the function's slope is at most `flat` times that at `v` [-]. The search compares slopes only, because values
/// near a minimum differ by less than their rounding. `slope` receives the gradient at the end of the step.
template <class Gradient>
double searchLine(Gradient& gradient, const Eigen::Vector2d& v, const Eigen::Vector2d& change, double flat,
                  Eigen::Vector2d& slope)
{
  constexpr int MAX_BISECTIONS = 60;
  const double first = slope.dot(change);
  slope = gradient(v + change);
  double low = 0.0;
  double high = 1.0;
  double length = 1.0;
  double here = slope.dot(change);
  for (int i = 0; i < MAX_BISECTIONS && (length < 1.0 || here > 0.0) && std::abs(here) > flat * std::abs(first); ++i)
  {
    (here > 0.0 ? high : low) = length;
    length = 0.5 * (low + high);
    slope = gradient(v + length * change);
    here = slope.dot(change);
  }
  return length;
}

/// Newton step of both speeds or, without `motor_free`, of the output's speed only.
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

/// Sum of the dry frictions that act only on the motor shaft [N.m].
double shaftStrength(const JointFriction& friction) noexcept
{
  double strength = 0.0;
  for (const FrictionTerm term : friction.terms)
  {
    strength += term.slip[1] == 0.0 ? term.strength * std::abs(term.slip[0]) : 0.0;
  }
  return strength;
}

/// Solves s + most r = free with r = s / sqrt(s^2 + e^2) for the slip s of one term. `free`: slip without this term's
/// friction; `most`: largest change of the slip by this friction; `e`: width of the regularisation. `share` receives r.
/// @returns false if the iteration does not converge.
bool solveSlip(double free, double most, double e, double& share)
{
  constexpr int MAX_ITERATIONS = 12;
  constexpr double ENOUGH = 1e-12;
  // The first guess is the solution without regularisation, in which the friction either holds the term or is full.
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

/// Terms of friction that continue to slide in a step. The compiler inlines the functions of this class into each
/// version of DryFriction::slide for a kind of processor.
class SlidingTerms
{
public:
  /// Terms that do not continue to slide.
  struct Stops
  {
    double number{};
    double places{};  // sum of the indices of these terms
  };

  /// Stores the terms. `strength` receives the sum of their torques on motor and output, with the signs of the old
  /// slips [N.m]. @returns false if `terms` is empty or has more than MAX_TERMS terms.
  inline __attribute__((always_inline)) bool take(const FrictionTerms& terms, const Eigen::Vector2d& old_speeds,
                                                  double follow, double width, Eigen::Vector2d& strength)
  {
    count_ = terms.packedSize();
    if (count_ == 0 || count_ > MAX_TERMS)
    {
      return false;
    }
    const double* __restrict__ c = terms.strength();
    const double* __restrict__ m = terms.byMotor();
    const double* __restrict__ o = terms.byOutput();
    const double motor = old_speeds[0];
    const double output = old_speeds[1];
    const double least = SLIDING * width;
    const auto take_term = [&](int j, auto& rows, int k)
    {
      sense_[j] = std::copysign(1.0, m[j] * motor + o[j] * output);
      by_motor_[j] = sense_[j] * m[j];
      by_output_[j] = sense_[j] * o[j];
      least_[j] = least * (std::abs(m[j]) + follow * std::abs(o[j]));
      rows[0][k] = c[j] * by_motor_[j];
      rows[1][k] = c[j] * by_output_[j];
    };
    const auto [by_motor, by_output] = fewSums<2>(count_, take_term);
    strength = { by_motor, by_output };
    return true;
  }

  inline __attribute__((always_inline)) Stops stops(const Eigen::Vector2d& speeds) const
  {
    const double motor = speeds[0];
    const double output = speeds[1];
    double number = 0.0;
    double places = 0.0;
#pragma omp simd reduction(+ : number, places)
    for (int j = 0; j < count_; ++j)
    {
      const double stopped = by_motor_[j] * motor + by_output_[j] * output < least_[j] ? 1.0 : 0.0;
      number += stopped;
      places += stopped * j;
    }
    return { number, places };
  }

  bool slid(std::size_t place, const Eigen::Vector2d& old_speeds) const
  {
    return by_motor_[place] * old_speeds[0] + by_output_[place] * old_speeds[1] >= MOVING / SLIDING * least_[place];
  }

  /// Removes the term at `place`. @returns the sign of the term's slip before the step.
  double leaveOut(int place)
  {
    least_[static_cast<std::size_t>(place)] = -HUGE_VAL;
    return sense_[static_cast<std::size_t>(place)];
  }

private:
  static constexpr int MAX_TERMS = 12;
  using Numbers = std::array<double, MAX_TERMS>;

  int count_{};
  alignas(32) Numbers sense_;
  alignas(32) Numbers by_motor_;   // slip per motor speed, with the sign that makes the slip before the step positive
  alignas(32) Numbers by_output_;  // slip per output speed, with the sign that makes the slip before the step positive
  alignas(32) Numbers least_;      // least slip of a term that continues to slide
};
}  // namespace

/// Width of the regularisation, the slip speed at which a term has 71 % of its friction. The width is the sum of the
/// slips by the motor speed `stiction_velocity` and by the output speed at this motor speed.
double DryFriction::width(const FrictionTerm& term, double velocity_ratio) const noexcept
{
  return width_ * (std::abs(term.slip[0]) + std::abs(velocity_ratio * term.slip[1])) + MIN_WIDTH;
}

HJT_VECTOR_CLONES DryFriction::Slopes DryFriction::slopes(const FrictionTerms& terms, double follow,
                                                          const Eigen::Vector2d& v) const noexcept
{
  const int count = terms.packedSize();
  const double* __restrict__ strength = terms.strength();
  const double* __restrict__ by_motor = terms.byMotor();
  const double* __restrict__ by_output = terms.byOutput();
  const double motor = v[0];
  const double output = v[1];
  const double width = width_;
  Slopes sum;
  const auto slope_of = [&](int j, auto& rows, int k)
  {
    const double m = by_motor[j];
    const double o = by_output[j];
    const double e = width * (std::abs(m) + follow * std::abs(o)) + MIN_WIDTH;
    const double slip = m * motor + o * output;
    const double inverse = 1.0 / std::sqrt(slip * slip + e * e);
    const double force = strength[j] * slip * inverse;
    const double stiffness = strength[j] * inverse * (e * inverse) * (e * inverse);
    rows[0][k] = force * m;
    rows[1][k] = force * o;
    rows[2][k] = stiffness * m * m;
    rows[3][k] = stiffness * m * o;
    rows[4][k] = stiffness * o * o;
  };
  const auto [first_0, first_1, second_00, second_01, second_11] = fewSums<5>(count, slope_of);
  sum.first = { first_0, first_1 };
  sum.second << second_00, second_01, second_01, second_11;
  return sum;
}

bool DryFriction::solve(const JointFriction& friction, double velocity_ratio, const Eigen::Vector2d& old_speeds,
                        const Eigen::Vector2d& free_speeds, double step, Eigen::Vector2d& speeds) const noexcept
{
  constexpr int MAX_ITERATIONS = 100;
  constexpr int FEW = 15;           // number of iterations that suffices for all but 1 of 300 random problems
  constexpr double ENOUGH = 1e-12;  // relative change of the speeds that ends the iteration
  constexpr double ROUNDED = 1e-9;  // relative change that counts as rounding of the speeds
  constexpr double FLAT = 0.1;      // slope at the end of a line search over the slope at its start
  constexpr double FLATTER = 1e-3;  // FLAT for a line search that must end at a kink, where a term sticks
  Eigen::Matrix2d linear = 0.5 * step * friction.viscous;
  const Eigen::Vector2d drag = linear * old_speeds - inertia_.cwiseProduct(free_speeds);
  linear.diagonal() += inertia_;
  Eigen::Matrix2d hessian;
  const auto gradient = [&](const Eigen::Vector2d& v) -> Eigen::Vector2d
  {
    const Slopes dry = slopes(friction.terms, std::abs(velocity_ratio), v);
    hessian = linear + step * dry.second;
    return linear * v + drag + step * dry.first;
  };

  // Minimises the function over both speeds or, without `motor_free`, over the output's speed alone.
  Eigen::Vector2d slope;
  const auto descend = [&](Eigen::Vector2d& v, bool motor_free)
  {
    Eigen::Vector2d change;
    const auto changes = [&](double share)
    {
      return !(std::abs(change[0]) <= share * (std::abs(v[0]) + width_) &&
               std::abs(change[1]) <= share * (std::abs(v[1]) + std::abs(velocity_ratio) * width_));
    };
    slope = gradient(v);
    change = newtonStep(hessian, slope, motor_free);
    for (int i = 0; i < MAX_ITERATIONS && changes(ENOUGH); ++i)
    {
      v += searchLine(gradient, v, change, i < FEW ? FLAT : FLATTER, slope) * change;
      change = newtonStep(hessian, slope, motor_free);
    }
    return !changes(ROUNDED);
  };

  // Sets the motor at rest. Returns whether the friction on the motor's shaft can hold the motor.
  const auto rests = [&](Eigen::Vector2d& v)
  {
    v[0] = 0.0;
    return descend(v, false) && std::abs(slope[0]) <= step * shaftStrength(friction);
  };
  speeds = old_speeds;
  if (old_speeds[0] == 0.0 && rests(speeds))
  {
    return true;
  }
  speeds = old_speeds;
  const bool found = descend(speeds, true);
  if (Eigen::Vector2d at_rest = speeds; std::abs(speeds[0]) < STICK_RANGE * width_ && rests(at_rest))
  {
    speeds = at_rest;
    return true;
  }
  return found;
}

HJT_VECTOR_CLONES bool DryFriction::slide(const JointFriction& friction, double velocity_ratio,
                                          const Eigen::Vector2d& old_speeds, const Eigen::Vector2d& free_momentum,
                                          double step, Eigen::Vector2d& speeds) const noexcept
{
  SlidingTerms sliding;
  Eigen::Vector2d strength;
  if (!sliding.take(friction.terms, old_speeds, std::abs(velocity_ratio), width_, strength))
  {
    return false;
  }
  const Eigen::Matrix2d viscous = 0.5 * step * friction.viscous;
  const double a = inertia_[0] + viscous(0, 0);
  const double b = viscous(0, 1);
  const double d = inertia_[1] + viscous(1, 1);
  const double inverse = 1.0 / (a * d - b * b);
  const auto answer = [&](const Eigen::Vector2d& to)
  { return Eigen::Vector2d(inverse * (d * to[0] - b * to[1]), inverse * (a * to[1] - b * to[0])); };
  Eigen::Vector2d v = answer(free_momentum - viscous * old_speeds - step * strength);
  const SlidingTerms::Stops stops = sliding.stops(v);
  if (stops.number > 1.0 || (stops.number > 0.0 && sliding.slid(static_cast<std::size_t>(stops.places), old_speeds)))
  {
    return false;
  }
  if (stops.number > 0.0)  // one term does not slide; the share of its strength is the unknown
  {
    const auto nearest = static_cast<int>(stops.places);
    const FrictionTerm term = friction.terms[nearest];
    const double strongest = step * term.strength;
    const Eigen::Vector2d response = answer(term.slip);
    v += strongest * sliding.leaveOut(nearest) * response;    // speeds without the friction of this term
    const double most = strongest * term.slip.dot(response);  // slip that the friction of this term can remove
    double share = 0.0;                                       // share of the strength of this term that acts
    if (!solveSlip(term.slip.dot(v), most, width(term, velocity_ratio), share))
    {
      return false;
    }
    v -= strongest * share * response;
    if (sliding.stops(v).number > 0.0)
    {
      return false;
    }
  }
  if (!(std::abs(v[0]) >= STICK_RANGE * width_))
  {
    return false;
  }
  speeds = v;
  return true;
}

/// Whether any term that slides at the speeds `before` is at rest or slides backwards at the speeds `after`.
HJT_VECTOR_CLONES bool DryFriction::anyStops(const FrictionTerms& terms, double follow, const Eigen::Vector2d& before,
                                             const Eigen::Vector2d& after) const noexcept
{
  const int count = terms.packedSize();
  const double* __restrict__ by_motor = terms.byMotor();
  const double* __restrict__ by_output = terms.byOutput();
  const double least = MOVING * width_;
  double stops = 0.0;
#pragma omp simd reduction(+ : stops)
  for (int j = 0; j < count; ++j)
  {
    const double m = by_motor[j];
    const double o = by_output[j];
    const double moves = least * (std::abs(m) + follow * std::abs(o)) + MIN_WIDTH;
    const double old = m * before[0] + o * before[1];
    const double now = std::copysign(1.0, old) * (m * after[0] + o * after[1]);
    stops += std::abs(old) >= moves && now < moves ? 1.0 : 0.0;
  }
  return stops > 0.0;
}

KickedSpeeds DryFriction::stopOrSlide(const JointFriction& friction, double velocity_ratio,
                                      const Eigen::Vector2d& old_speeds, const Eigen::Vector2d& free_momentum,
                                      double step, JointFriction& sticking) const noexcept
{
  constexpr int MAX_PARTS = 16;  // largest number of parts of a step; up to ten teeth stop in a step
  const Eigen::Vector2d gained = free_momentum.cwiseQuotient(inertia_) - old_speeds;  // gain without friction [rad/s]
  KickedSpeeds speeds{ old_speeds, old_speeds };
  double rest = 1.0;  // remaining share of the step [-]
  const auto go_on = [&](double share, const Eigen::Vector2d& to)
  {
    if (rest >= 0.5 && rest * (1.0 - share) <= 0.5)
    {
      speeds.halfway += (rest - 0.5) / (rest * share) * (to - speeds.after);
    }
    else if (rest > 0.5)
    {
      speeds.halfway = to;
    }
    speeds.after = to;
    rest *= 1.0 - share;
  };
  for (int part = 1;; ++part)
  {
    Eigen::Vector2d undivided;
    speeds.solved = solve(friction, velocity_ratio, speeds.after, speeds.after + rest * gained, rest * step, undivided);
    if (!speeds.solved)
    {
      return speeds;
    }
    if (part == MAX_PARTS || !anyStops(friction.terms, std::abs(velocity_ratio), speeds.after, undivided))
    {
      go_on(1.0, undivided);
      return speeds;
    }
    const auto moves = [&](const FrictionTerm& term)
    { return std::abs(term.slip.dot(speeds.after)) >= MOVING * width(term, velocity_ratio); };
    sticking.terms.clear();
    sticking.viscous = friction.viscous;
    Eigen::Vector2d free = speeds.after + rest * gained;
    for (const FrictionTerm term : friction.terms)
    {
      if (!moves(term))
      {
        sticking.terms.push_back(term);
        continue;
      }
      free -=
          rest * step * std::copysign(term.strength, term.slip.dot(speeds.after)) * term.slip.cwiseQuotient(inertia_);
    }
    Eigen::Vector2d onward;
    const bool found = solve(sticking, velocity_ratio, speeds.after, free, rest * step, onward);
    double share = 1.0;  // share of the remaining time before a term stops [-]
    for (const FrictionTerm term : friction.terms)
    {
      const double before = term.slip.dot(speeds.after);
      const double after = term.slip.dot(onward);
      share = found && moves(term) && before * after < 0.0 ? std::min(share, before / (before - after)) : share;
    }
    go_on(share, share < 1.0 ? speeds.after + share * (onward - speeds.after) : undivided);
    if (share == 1.0)
    {
      return speeds;
    }
  }
}

Eigen::Vector2d DryFriction::torque(const JointFriction& friction, double velocity_ratio,
                                    const Eigen::Vector2d& speeds) const noexcept
{
  Eigen::Vector2d torque = -friction.viscous * speeds;
  for (const FrictionTerm term : friction.terms)
  {
    const double slip = term.slip.dot(speeds);
    torque -= term.strength * slip / std::hypot(slip, width(term, velocity_ratio)) * term.slip;
  }
  return torque;
}
}  // namespace hjt
