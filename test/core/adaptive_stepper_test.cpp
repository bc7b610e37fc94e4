// SPDX-License-Identifier: BSD-3-Clause
#include "solver/adaptive_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "test/support/allocation_count.hpp"
#include "test/support/temporary_folder.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
/// A folder that every test of this program shares as cache, so that the surface is built once.
SurfaceSource cached()
{
  static const TemporaryFolder FOLDER;
  return { FOLDER.path().string(), {}, {} };
}

Parameters onSurface(std::vector<std::string> assignments)
{
  assignments.insert(assignments.begin(), { "solver.scene=auto", "input.command_timeout=10.0" });
  return shippedParameters(assignments);
}

Parameters adaptive(const std::string& tolerance, std::vector<std::string> assignments = {})
{
  assignments.insert(assignments.begin(), { "solver.stepper=adaptive", "solver.rate=1000",
                                            "indicators.sample_rate=1000", "solver.tolerance=" + tolerance });
  return onSurface(assignments);
}

using Inputs = std::vector<Input>;
using Course = std::vector<JointOutputs>;

/// What comes out every millisecond.
Course run(const Parameters& parameters, const Inputs& inputs, Stamp duration)
{
  Twin twin(parameters, cached());
  Course course;
  for (const Input& input : inputs)
  {
    twin.push(input);
  }
  while (twin.step(duration))
  {
    if (twin.stamp() % MILLISECOND == 0)
    {
      course.push_back(twin.outputs());
    }
  }
  EXPECT_EQ(twin.counters().solver_failures, 0u);
  return course;
}

/// Speeding up against a load, the torque reversed, the motor through its standstill, the load reversed, the brake
/// closed and opened again.
Inputs eventfulInputs()
{
  return {
    { MILLISECOND, InputKind::LOAD_TORQUE, 20.0, {} },       { 10 * MILLISECOND, InputKind::MOTOR_TORQUE, 0.5, {} },
    { 80 * MILLISECOND, InputKind::MOTOR_TORQUE, -0.5, {} }, { 200 * MILLISECOND, InputKind::LOAD_TORQUE, -30.0, {} },
    { 250 * MILLISECOND, InputKind::BRAKE, 1.0, {} },        { 300 * MILLISECOND, InputKind::LOAD_TORQUE, 30.0, {} },
    { 350 * MILLISECOND, InputKind::BRAKE, 0.0, {} }
  };
}
constexpr Stamp EVENTFUL = 400 * MILLISECOND;

struct Differences
{
  double motor_angle{};   // [rad]
  double output_angle{};  // [rad]
  double joint_torque{};  // [N.m]
};

Differences between(const Course& one, const Course& other)
{
  Differences largest;
  EXPECT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i)
  {
    largest.motor_angle = std::max(largest.motor_angle, std::abs(one[i].motor_angle - other[i].motor_angle));
    largest.output_angle = std::max(largest.output_angle, std::abs(one[i].output_angle - other[i].output_angle));
    largest.joint_torque = std::max(largest.joint_torque, std::abs(one[i].joint_torque - other[i].joint_torque));
  }
  return largest;
}

/// Largest energy residual over the work done.
double imbalance(const Course& course)
{
  double largest = 0.0;
  double dissipated = 0.0;
  for (const JointOutputs& outputs : course)
  {
    largest = std::max(largest, std::abs(outputs.energy_residual));
    dissipated = outputs.dissipated_energy;
  }
  return largest / dissipated;
}

TEST(AdaptiveStepper, goesWhereFixedStepsGoAsTheyGetShorter)
{
  const Course fine = run(adaptive("1.0e-12"), eventfulInputs(), EVENTFUL);
  constexpr double TRAVEL = 28.0;  // of the motor [rad]
  constexpr double TORQUE = 60.0;  // largest [N.m]
  double last = 0.0;
  for (const auto& [rate, share] : { std::pair("1.0e+5", 2e-4), std::pair("1.0e+6", 2e-5) })
  {
    const Course fixed = run(onSurface({ std::string("solver.rate=") + rate }), eventfulInputs(), EVENTFUL);
    const Differences apart = between(fixed, fine);
    EXPECT_LT(apart.motor_angle, share * TRAVEL) << rate;
    EXPECT_LT(apart.output_angle, share * TRAVEL / 101.0) << rate;
    EXPECT_LT(apart.joint_torque, 100.0 * share * TORQUE) << rate;  // while it swings
    if (last > 0.0)
    {
      EXPECT_LT(apart.motor_angle, 0.2 * last);
    }
    last = apart.motor_angle;
  }
}

TEST(AdaptiveStepper, errsLessByAFinerTolerance)
{
  const Course fine = run(adaptive("1.0e-12"), eventfulInputs(), EVENTFUL);
  for (const auto& [tolerance, angle, torque] :
       { std::tuple("1.0e-6", 4e-4, 12.0), std::tuple("1.0e-8", 7e-5, 1.4), std::tuple("1.0e-10", 8e-6, 0.08) })
  {
    const Differences apart = between(run(adaptive(tolerance), eventfulInputs(), EVENTFUL), fine);
    EXPECT_LT(apart.output_angle, angle) << tolerance;
    EXPECT_LT(apart.joint_torque, torque) << tolerance;
  }
}

TEST(AdaptiveStepper, followsRandomInputs)
{
  constexpr Stamp DURATION = 500 * MILLISECOND;
  for (const unsigned seed : { 1u, 2u, 3u })
  {
    Inputs inputs = randomInputs(seed, DURATION, 1.0, 60.0);
    for (Input& input : inputs)
    {
      input.stamp = (input.stamp / MILLISECOND + 1) * MILLISECOND;
    }
    const Course fixed = run(onSurface({ "solver.rate=200000" }), inputs, DURATION);
    const Course course = run(adaptive("1.0e-8"), inputs, DURATION);
    EXPECT_LT(between(fixed, course).output_angle, 1e-3) << seed;
    EXPECT_LT(imbalance(course), 3e-3) << seed;
  }
}

/// At the speed limit from 30 ms on, off it under load and back, the torque reversed there and up to the limit again.
Inputs limitedInputs()
{
  return { { MILLISECOND, InputKind::MOTOR_TORQUE, 1.0, {} },
           { 120 * MILLISECOND, InputKind::LOAD_TORQUE, 90.0, {} },
           { 200 * MILLISECOND, InputKind::LOAD_TORQUE, -40.0, {} },
           { 260 * MILLISECOND, InputKind::MOTOR_TORQUE, -1.0, {} } };
}

TEST(AdaptiveStepper, holdsTheDrivesLimitAndLagAtAnyRate)
{
  constexpr double LIMIT = 60.0;  // [rad/s]
  for (const char* bandwidth : { "0.0", "150.0", "2000.0" })
  {
    const std::vector<std::string> drive{ "motor.speed_limit=60.0",
                                          std::string("motor.current_bandwidth=") + bandwidth };
    std::vector<std::string> fixed = drive;
    fixed.emplace_back("solver.rate=1.0e+6");
    const Course fine = run(onSurface(fixed), limitedInputs(), EVENTFUL);
    const Course course = run(adaptive("1.0e-9", drive), limitedInputs(), EVENTFUL);
    const Differences apart = between(fine, course);
    EXPECT_LT(apart.motor_angle, 2e-3) << bandwidth;  // of 10 rad
    EXPECT_LT(apart.output_angle, 4e-5) << bandwidth;
    EXPECT_GT(course[99].motor_velocity, 0.98 * LIMIT);
    EXPECT_LT(imbalance(course), 1e-3) << bandwidth;
    for (std::size_t i = 0; i < course.size(); ++i)
    {
      ASSERT_NEAR(course[i].motor_torque, fine[i].motor_torque, 0.05) << bandwidth << " at " << i;
    }
  }
}

TEST(AdaptiveStepper, breaksAwayWhenTheCurrentHasRisen)
{
  // 1 N.m in the end, 0.08 N.m after 13 ms.
  const std::vector<std::string> slow{ "motor.current_bandwidth=1.0" };
  const Inputs inputs{ { MILLISECOND, InputKind::MOTOR_TORQUE, 1.0, {} } };
  const Course course = run(adaptive("1.0e-9", slow), inputs, 60 * MILLISECOND);
  std::vector<std::string> fixed = slow;
  fixed.emplace_back("solver.rate=1.0e+6");
  const Course fine = run(onSurface(fixed), inputs, 60 * MILLISECOND);
  EXPECT_EQ(course[4].motor_angle, 0.0);
  EXPECT_GT(course[59].motor_angle, 0.1);
  EXPECT_LT(between(course, fine).motor_angle, 1e-3 * course[59].motor_angle);
}

TEST(AdaptiveStepper, balancesItsEnergy)
{
  EXPECT_LT(imbalance(run(adaptive("1.0e-7"), eventfulInputs(), EVENTFUL)), 3e-3);
  EXPECT_LT(imbalance(run(adaptive("1.0e-10"), eventfulInputs(), EVENTFUL)), 1e-4);
}

TEST(AdaptiveStepper, stopsTheMotorExactlyWhereTheBrakeHoldsIt)
{
  const Course course = run(adaptive("1.0e-9"), eventfulInputs(), EVENTFUL);
  const auto at = [&](Stamp milliseconds) { return course[static_cast<std::size_t>(milliseconds - 1)]; };
  ASSERT_NE(at(249).motor_velocity, 0.0);
  for (Stamp time = 260; time <= 349; ++time)
  {
    EXPECT_EQ(at(time).motor_velocity, 0.0) << time;
    EXPECT_EQ(at(time).motor_angle, at(260).motor_angle) << time;
  }
  EXPECT_NE(at(310).output_velocity, 0.0);  // it swings after the load
  EXPECT_NE(at(360).motor_velocity, 0.0);
}

TEST(AdaptiveStepper, staysStuckBelowBreakawayAndSlidesAboveIt)
{
  // Unloaded, the shaft takes some 0.07 N.m to break away.
  const Inputs inputs{ { MILLISECOND, InputKind::MOTOR_TORQUE, 0.05, {} },
                       { 50 * MILLISECOND, InputKind::MOTOR_TORQUE, 0.12, {} },
                       { 100 * MILLISECOND, InputKind::MOTOR_TORQUE, 0.0, {} } };
  const Course course = run(adaptive("1.0e-9"), inputs, 200 * MILLISECOND);
  EXPECT_EQ(course[48].motor_angle, 0.0);
  EXPECT_GT(course[98].motor_angle, 0.05);
  EXPECT_EQ(course[199].motor_velocity, 0.0);
  const Course fixed = run(onSurface({ "solver.rate=1.0e+6" }), inputs, 200 * MILLISECOND);
  EXPECT_NEAR(course[199].motor_angle, fixed[199].motor_angle, 1e-4 * fixed[199].motor_angle);
}

TEST(AdaptiveStepper, holdsAnOutputWithDryFriction)
{
  const std::vector<std::string> seals{ "output.coulomb_torque=5.0" };
  const Course course = run(adaptive("1.0e-10", seals), eventfulInputs(), EVENTFUL);
  std::vector<std::string> fixed = seals;
  fixed.emplace_back("solver.rate=1.0e+6");
  const Differences apart = between(run(onSurface(fixed), eventfulInputs(), EVENTFUL), course);
  EXPECT_LT(apart.motor_angle, 2e-3);
  EXPECT_LT(apart.output_angle, 2e-5);
  EXPECT_LT(apart.joint_torque, 0.1);
}

TEST(AdaptiveStepper, givesTheSameBitsEveryTimeWheneverItHearsOfItsInputs)
{
  const Course once = run(adaptive("1.0e-8"), eventfulInputs(), EVENTFUL);
  Twin twin(adaptive("1.0e-8"), cached());
  const Inputs inputs = eventfulInputs();
  std::size_t next = 0;
  std::size_t row = 0;
  while (twin.stamp() < EVENTFUL)
  {
    for (; next < inputs.size() && inputs[next].stamp <= twin.stamp() + MILLISECOND; ++next)
    {
      twin.push(inputs[next]);
    }
    ASSERT_TRUE(twin.step(twin.stamp() + MILLISECOND));
    ASSERT_EQ(numbers(twin.outputs()), numbers(once[row++]));
  }
}

TEST(AdaptiveStepper, errsNoMoreWhereItIsLookedAtMoreOften)
{
  const Course seldom = run(adaptive("1.0e-8"), eventfulInputs(), EVENTFUL);
  const Course often = run(adaptive("1.0e-8", { "solver.rate=10000" }), eventfulInputs(), EVENTFUL);
  EXPECT_LT(between(seldom, often).output_angle, 7e-5);
}

TEST(AdaptiveStepper, leavesToTheLeapfrogWhatItDoesNotCover)
{
  // The full ring, and a cup with one Coulomb element.
  for (const char* other : { "solver.scene=full_ring", "cup.friction_angle=0.0" })
  {
    const Stamp duration = other == std::string("solver.scene=full_ring") ? 20 * MILLISECOND : EVENTFUL;
    const Course same =
        run(onSurface({ "solver.rate=1000", "indicators.sample_rate=1000", other }), eventfulInputs(), duration);
    const Course course = run(adaptive("1.0e-8", { other }), eventfulInputs(), duration);
    ASSERT_EQ(course.size(), same.size());
    for (std::size_t i = 0; i < course.size(); ++i)
    {
      ASSERT_EQ(numbers(course[i]), numbers(same[i])) << other;
    }
  }
}

TEST(AdaptiveStepper, comesBackFromAnEngagedBrakeWithPlay)
{
  const std::vector<std::string> play{ "brake.play=0.02" };
  std::vector<std::string> often = play;
  often.emplace_back("solver.rate=10000");
  const Course course = run(adaptive("1.0e-9", often), eventfulInputs(), EVENTFUL);
  std::vector<std::string> fixed = play;
  fixed.emplace_back("solver.rate=1.0e+6");
  const Differences apart = between(run(onSurface(fixed), eventfulInputs(), EVENTFUL), course);
  EXPECT_LT(apart.motor_angle, 0.02);
  EXPECT_LT(apart.output_angle, 2e-4);
  EXPECT_LT(imbalance(course), 1e-2);
}

TEST(AdaptiveStepper, allocatesNothing)
{
  Twin twin(adaptive("1.0e-9"), cached());
  for (const Input& input : eventfulInputs())
  {
    twin.push(input);
  }
  const std::size_t before = allocationCount();
  advance(twin, EVENTFUL);
  EXPECT_EQ(allocationCount(), before);
}
}  // namespace
}  // namespace hjt
