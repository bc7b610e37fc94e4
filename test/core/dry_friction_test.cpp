// SPDX-License-Identifier: BSD-3-Clause
#include "solver/dry_friction.hpp"
#include "test/support/seeded_random.hpp"

#include <cmath>

namespace hjt
{
namespace
{
constexpr double STEP = 1e-4;   // [s]
constexpr double WIDTH = 1e-6;  // stiction velocity [rad/s]
constexpr double VELOCITY_RATIO = 1.0 / 101.0;

/// A step of random friction: a shaft, many flanks, viscous terms. `wide`: inertias, strengths and torques over six
/// decades in place of four.
struct RandomStep
{
  explicit RandomStep(SeededRandom& random, int flanks = 12, bool wide = false) : friction(200)
  {
    const auto size = [&] { return std::pow(10.0, (wide ? 3.0 : 2.0) * random.uniform() - 1.0); };
    inertia = { 1.7e-4 * size() * 10.0, 0.5 * size() * 10.0 };
    friction.terms.push_back({ 0.2 * size(), { 1.0, 0.0 } });
    for (int i = 0; i < flanks; ++i)
    {
      friction.terms.push_back({ 100.0 * size(), { 1e-4 * random.uniform(), 1e-2 * random.uniform() } });
    }
    const Eigen::Vector2d direction(random.uniform(), 10.0 * random.uniform());
    friction.viscous = 1e-4 * direction * direction.transpose();
    // Speeds from stuck to full speed, the free ones near enough to be stopped now and then.
    const double speed = random.uniform() * std::pow(10.0, 4.0 * random.uniform() - 2.0);
    old = { speed, speed * VELOCITY_RATIO + 1e-3 * random.uniform() * size() };
    free = old + Eigen::Vector2d(random.uniform(), random.uniform())
                         .cwiseProduct(STEP * Eigen::Vector2d(0.5, 50.0))
                         .cwiseQuotient(inertia) *
                     (wide ? size() : 1.0);
  }

  double potential(const Eigen::Vector2d& v) const
  {
    const Eigen::Vector2d change = v - free;
    const Eigen::Vector2d mean = v + old;
    double value = 0.5 * change.dot(inertia.cwiseProduct(change)) + 0.25 * STEP * mean.dot(friction.viscous * mean);
    for (const FrictionTerm term : friction.terms)
    {
      const double width = WIDTH * (std::abs(term.slip[0]) + VELOCITY_RATIO * std::abs(term.slip[1]));
      value += STEP * term.strength * std::hypot(term.slip.dot(v), width);
    }
    return value;
  }

  Eigen::Vector2d solve(const DryFriction& dry) const
  {
    Eigen::Vector2d speeds;
    EXPECT_TRUE(dry.solve(friction, VELOCITY_RATIO, old, free, STEP, speeds));
    return speeds;
  }

  double shaft() const { return friction.terms[0].strength; }  // [N.m]

  JointFriction friction;
  Eigen::Vector2d inertia;
  Eigen::Vector2d old;
  Eigen::Vector2d free;
};

/// Minimum of a convex function of one variable in [low, high], by thirds.
template <class Function>
double minimum(double low, double high, const Function& function)
{
  for (int i = 0; i < 90; ++i)
  {
    const double third = (high - low) / 3.0;
    if (function(low + third) < function(high - third))
    {
      high -= third;
    }
    else
    {
      low += third;
    }
  }
  return 0.5 * (low + high);
}

TEST(DryFriction, IsTheMinimumFoundByBruteForce)
{
  SeededRandom random(61);
  int stuck = 0;
  for (int k = 0; k < 60; ++k)
  {
    const RandomStep step(random);
    const DryFriction dry(step.inertia, WIDTH);
    const Eigen::Vector2d v = step.solve(dry);
    const double reach = 2.0 * (step.free.cwiseAbs() + step.old.cwiseAbs()).maxCoeff() * 101.0 + 1e-3;
    const auto best_output = [&](double motor) {
      return minimum(-reach, reach, [&](double output) { return step.potential({ motor, output }); });
    };
    const double motor = minimum(-reach, reach, [&](double m) { return step.potential({ m, best_output(m) }); });
    const Eigen::Vector2d brute(motor, best_output(motor));
    // Values near a minimum are flat: two numbers that agree to rounding are all that can be asked of them.
    const double scale = step.potential(step.old) + step.potential(step.free) + step.potential({ 0.0, 0.0 });
    // A motor at rest is held exactly; the potential rounds the kink there off by the regularising speed.
    const double kink = v[0] == 0.0 ? STEP * step.shaft() * WIDTH : 0.0;
    EXPECT_LE(step.potential(v), step.potential(brute) + 1e-14 * scale + kink) << k;
    stuck += std::abs(v[0]) < 100.0 * WIDTH ? 1 : 0;
  }
  EXPECT_GT(stuck, 3);
  EXPECT_LT(stuck, 57);
}

TEST(DryFriction, SlidesAsItIsSolved)
{
  SeededRandom random(64);
  int slid = 0;
  for (int k = 0; k < 20000; ++k)
  {
    RandomStep step(random, 1 + k % 7);
    if (k % 2 == 0)
    {
      step.friction.terms.push_back({ 2.0, { 0.0, 1.0 } });  // of the output
    }
    if (k % 3 == 0)
    {
      step.friction.terms.push_back({ 0.1, { 0.0, 0.0 } });  // that nothing slips
    }
    const DryFriction dry(step.inertia, WIDTH);
    Eigen::Vector2d v(1e9, 1e9);
    if (!dry.slide(step.friction, VELOCITY_RATIO, step.old, step.inertia.cwiseProduct(step.free), STEP, v))
    {
      EXPECT_EQ(v, Eigen::Vector2d(1e9, 1e9)) << k;
      continue;
    }
    ++slid;
    const Eigen::Vector2d solved = step.solve(dry);
    // The tails of the regularisation: 1e-9 of the friction; and what `solve` leaves, 1e-12 of the speeds.
    const Eigen::Vector2d friction =
        (step.inertia.cwiseProduct(solved - step.free)).cwiseAbs() + Eigen::Vector2d::Constant(1e-12);
    const Eigen::Vector2d error = step.inertia.cwiseProduct(v - solved).cwiseAbs();
    EXPECT_LE(error[0], 1e-8 * friction[0] + 1e-10 * step.inertia[0] * std::abs(solved[0])) << k;
    EXPECT_LE(error[1], 1e-8 * friction[1] + 1e-10 * step.inertia[1] * std::abs(solved[1])) << k;
  }
  EXPECT_GT(slid, 2000);
  for (int k = 0; k < 1000; ++k)
  {
    const RandomStep many(random, 12);
    Eigen::Vector2d v;
    EXPECT_FALSE(DryFriction(many.inertia, WIDTH)
                     .slide(many.friction, VELOCITY_RATIO, many.old, many.inertia.cwiseProduct(many.free), STEP, v));
  }
}

TEST(FrictionTerms, HaveZerosBehindTheLastWhateverWasThere)
{
  FrictionTerms terms(7);
  for (const int count : { 7, 1, 4, 5, 0 })
  {
    terms.clear();
    for (int i = 0; i < count; ++i)
    {
      terms.push_back({ 2.0, { 3.0, 4.0 } });
    }
    ASSERT_EQ(terms.size(), count);
    EXPECT_EQ(terms.packedSize() % FrictionTerms::PACK, 0);
    EXPECT_GE(terms.packedSize(), count);
    for (int i = 0; i < terms.packedSize(); ++i)
    {
      const double there = i < count ? 1.0 : 0.0;
      EXPECT_EQ(terms[i].strength, 2.0 * there) << i << " of " << count;
      EXPECT_EQ(terms[i].slip, Eigen::Vector2d(3.0 * there, 4.0 * there)) << i << " of " << count;
    }
  }
}

/// Momentum that the speeds after a step leave unbalanced, by motor and output, over what acts there [-].
Eigen::Vector2d unbalanced(const RandomStep& step)
{
  const DryFriction dry(step.inertia, WIDTH);
  const Eigen::Vector2d v = step.solve(dry);
  // M (v - v_free) = h (dry friction at v + viscous friction at the mean speed)
  const Eigen::Vector2d at_end = dry.torque(step.friction, VELOCITY_RATIO, v) + step.friction.viscous * v;
  const Eigen::Vector2d at_mean = -0.5 * step.friction.viscous * (v + step.old);
  Eigen::Vector2d error = (step.inertia.cwiseProduct(v - step.free) - STEP * (at_end + at_mean)).cwiseAbs();
  Eigen::Vector2d scale = step.inertia.cwiseProduct(step.free.cwiseAbs() + v.cwiseAbs() + step.old.cwiseAbs());
  for (const FrictionTerm term : step.friction.terms)
  {
    scale += STEP * term.strength * term.slip.cwiseAbs();
  }
  error[0] -= v[0] == 0.0 ? STEP * step.shaft() : 0.0;  // that holds it
  return error.cwiseQuotient(scale);
}

TEST(DryFriction, LeavesNoForceUnbalanced)
{
  SeededRandom random(62);
  for (int k = 0; k < 3000; ++k)
  {
    // The search ends where the potential no longer falls by its own rounding: half the digits of the speeds, and of
    // what sticks, friction within 1e-6 rad/s, some fewer.
    EXPECT_LT(unbalanced(RandomStep(random)).maxCoeff(), 1e-4) << k;
  }
}

/// Of some 80 000 such problems one: each Newton step leads across the kink of a term that sticks, and a search that
/// ends beside it comes no nearer.
TEST(DryFriction, IsSolvedAlongAKinkToo)
{
  for (const unsigned seed : { 158178U, 185631U, 277132U, 325960U, 381505U })
  {
    SeededRandom random(seed);
    EXPECT_LT(unbalanced(RandomStep(random, 59, true)).maxCoeff(), 1e-4) << seed;
  }
}

TEST(DryFriction, SaysThatNumbersOverflow)
{
  const DryFriction dry({ 1e-4, 0.5 }, WIDTH);
  JointFriction friction(1);
  friction.terms.push_back({ 0.2, { 1.0, 0.0 } });
  Eigen::Vector2d speeds;
  EXPECT_FALSE(dry.solve(friction, VELOCITY_RATIO, { 1.0, 0.01 }, { HUGE_VAL, 0.01 }, STEP, speeds));
  JointFriction sticking(1);
  EXPECT_FALSE(dry.stopOrSlide(friction, VELOCITY_RATIO, { 1.0, 0.01 }, { HUGE_VAL, 0.005 }, STEP, sticking).solved);
}

/// One mass on the motor side with Coulomb friction alone.
class Slider : public testing::Test
{
protected:
  static constexpr double INERTIA = 2e-4;
  static constexpr double COULOMB = 0.3;

  Slider() { friction_.terms.push_back({ COULOMB, { 1.0, 0.0 } }); }

  /// Speed after a step under `torque`.
  double stepped(double speed, double torque) const
  {
    const Eigen::Vector2d old(speed, 0.0);
    Eigen::Vector2d speeds;
    EXPECT_TRUE(dry_.solve(friction_, VELOCITY_RATIO, old, { speed + STEP * torque / INERTIA, 0.0 }, STEP, speeds));
    return speeds[0];
  }

  JointFriction friction_{ 0 };
  DryFriction dry_{ Eigen::Vector2d(INERTIA, 0.5), WIDTH };
};

TEST_F(Slider, SticksBelowBreakaway)
{
  for (const double share : { 0.0, 0.5, -0.99 })
  {
    double speed = 0.0;
    for (int i = 0; i < 100; ++i)
    {
      speed = stepped(speed, share * COULOMB);
    }
    EXPECT_EQ(speed, 0.0) << share;
  }
}

TEST_F(Slider, SlidesWithFullFrictionAboveBreakaway)
{
  double speed = 0.0;
  for (int i = 1; i <= 100; ++i)
  {
    speed = stepped(speed, 1.5 * COULOMB);
    // Half a square of e / v less than Coulomb's friction, summed over the steps.
    EXPECT_NEAR(speed, i * STEP * 0.5 * COULOMB / INERTIA, 1e-6 * speed) << i;
  }
}

TEST_F(Slider, StopsAndDoesNotRunBackwards)
{
  double speed = 1.0;
  for (int i = 0; i < 100; ++i)
  {
    const double next = stepped(speed, 0.0);
    EXPECT_LE(next, speed);
    EXPECT_GE(next, 0.0);
    EXPECT_NEAR(speed - next, std::min(STEP * COULOMB / INERTIA, speed), 1e-5);
    speed = next;
  }
  EXPECT_LT(speed, 1e-12);
}

TEST_F(Slider, ReversesWithinAStep)
{
  // Needs 0.3 of the step to stop, then slides back under the rest of the torque, friction turned round.
  const double torque = -10.0 * COULOMB;
  const double speed = 0.3 * STEP * 11.0 * COULOMB / INERTIA;
  // Implicit: friction at the end of the step, all of it against the new direction.
  EXPECT_NEAR(stepped(speed, torque), speed + STEP * (torque + COULOMB) / INERTIA, 1e-9);
}

TEST_F(Slider, TorqueOpposesTheSpeedAndIsOdd)
{
  for (const double speed : { 1e-9, 1e-6, 1.0, 300.0 })
  {
    const double torque = dry_.torque(friction_, VELOCITY_RATIO, { speed, 0.0 })[0];
    EXPECT_NEAR(torque, -COULOMB * speed / std::hypot(speed, WIDTH), 1e-15);
    EXPECT_EQ(dry_.torque(friction_, VELOCITY_RATIO, { -speed, 0.0 })[0], -torque);
  }
  EXPECT_EQ(dry_.torque(friction_, VELOCITY_RATIO, { 0.0, 0.0 })[0], 0.0);
}

TEST(DryFriction, WithoutFrictionLeavesTheFreeSpeeds)
{
  const DryFriction dry({ 1e-4, 0.5 }, WIDTH);
  const JointFriction none(0);
  const Eigen::Vector2d free(3.0, -0.2);
  Eigen::Vector2d speeds;
  EXPECT_TRUE(dry.solve(none, VELOCITY_RATIO, { 1.0, 1.0 }, free, STEP, speeds));
  EXPECT_LT((speeds - free).norm(), 1e-14);
}

TEST(DryFriction, NeverFeedsEnergyIn)
{
  SeededRandom random(63);
  for (int k = 0; k < 3000; ++k)
  {
    const RandomStep step(random);
    const DryFriction dry(step.inertia, WIDTH);
    const Eigen::Vector2d v = step.solve(dry);
    EXPECT_LE(dry.torque(step.friction, VELOCITY_RATIO, v).dot(v), 0.0);
    // Over the step: friction takes kinetic energy from the free motion, or none.
    const double taken =
        0.5 * step.free.dot(step.inertia.cwiseProduct(step.free)) - 0.5 * v.dot(step.inertia.cwiseProduct(v));
    const Eigen::Vector2d viscous_drag = step.friction.viscous * step.old;
    EXPECT_GE(taken, -STEP * std::abs(viscous_drag.dot(v)) - 1e-12 * std::abs(taken)) << k;
  }
}
}  // namespace
}  // namespace hjt
