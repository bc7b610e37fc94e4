// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_twin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "arm/arm_motion.hpp"
#include "arm/moving_arm.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "test/core/complaint.hpp"
#include "test/core/rods.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
/// Motor torque that comes in smoothly [N.m].
double torqueAt(double time)
{
  constexpr double RISE = 0.05;
  return 0.35 * (time < RISE ? 0.5 - 0.5 * std::cos(M_PI * time / RISE) : 1.0);
}

void run(ArmTwin& arm, double duration, const std::function<void(double)>& each = {})
{
  const Stamp end = toStampLength(duration);
  for (std::size_t i = 0; i < arm.joints(); ++i)
  {
    arm.drive(i).commandBrake(0, false);
  }
  while (arm.stamp() + arm.stepLength() <= end)
  {
    const double time = toSeconds(arm.stamp() + arm.stepLength());
    for (std::size_t i = 0; i < arm.joints(); ++i)
    {
      arm.drive(i).commandMotorTorque(arm.stamp() + arm.stepLength(), (i == 0 ? 1.0 : -0.6) * torqueAt(time));
    }
    ASSERT_TRUE(arm.step(end));
    if (each)
    {
      each(time);
    }
  }
}

TEST(ArmTwin, OneJointOfConstantInertiaIsATwin)
{
  constexpr double DURATION = 0.2;
  ArmTwin arm(rods("0 0 1", 1), { drive() }, { 0.4 });
  Parameters parameters = drive();
  parameters.output.load_inertia = 0.08 + 4.0 * 0.3 * 0.3;
  parameters.brake.engaged_at_start = true;
  Twin twin(parameters);
  twin.commandBrake(0, false);
  run(arm, DURATION,
      [&](double time)
      {
        twin.commandMotorTorque(twin.stamp() + twin.stepLength(), torqueAt(time));
        ASSERT_TRUE(twin.step(toStampLength(DURATION)));
        ASSERT_NEAR(arm.motion()[0].position - 0.4, twin.outputs().output_angle, 1e-12);
        ASSERT_NEAR(arm.motion()[0].velocity, twin.outputs().output_velocity, 1e-9);
      });
  EXPECT_GT(twin.outputs().output_angle, 0.1);
}

/// Largest error of the coupling [J] while two joints of the shipped drive swing a double pendulum.
double couplingError(double rate, double mass_rate)
{
  ArmTwin arm(rods("0 1 0", 2), { drive(rate), drive(rate) }, { 0.3, -0.8 }, {}, { mass_rate, 1 });
  double largest = 0.0;
  run(arm, 0.3, [&](double) { largest = std::max(largest, std::abs(arm.energyResidual())); });
  EXPECT_GT(std::abs(arm.deliveredEnergy()), 1.0);
  return largest;
}

TEST(ArmTwin, WhatTheDrivesDeliverIsWhatTheArmHoldsUpToTheSquareOfTheStep)
{
  const double coarse = couplingError(10e3, 10e3);
  const double fine = couplingError(20e3, 20e3);
  EXPECT_GT(coarse / fine, 3.5);
  EXPECT_LT(coarse / fine, 4.5);
}

TEST(ArmTwin, AMassMatrixTakenLessOftenCostsInProportion)
{
  const double seldom = couplingError(10e3, 500.0);
  const double often = couplingError(10e3, 1000.0);
  EXPECT_GT(seldom / often, 1.5);
  EXPECT_LT(seldom / often, 2.5);
}

/// Within an arm a step is divided by the inertia that the pose shows the joint, and less than of a drive alone.
TEST(ArmTwin, ALightLinkIsDividedLessAndMovesAlike)
{
  constexpr double LIGHT = 3e-4;          // [kg.m^2]
  constexpr double LEAST_TORSION = 5e-4;  // [rad]
  Parameters parameters = drive();
  parameters.output.load_inertia = LIGHT;
  Twin alone(parameters);
  Twin within(parameters);
  double torsion = 0.0;
  const auto step = [&](double inertia)
  {
    const Stamp next = within.stamp() + within.stepLength();
    for (Twin* twin : { &alone, &within })
    {
      twin->commandMotorTorque(next, torqueAt(toSeconds(next)));
      twin->commandLoadTorque(next, 50.0 * torqueAt(toSeconds(next)));
    }
    within.coupleArm(inertia, 0.0);
    EXPECT_TRUE(within.step(next));
  };
  while (within.stamp() < toStampLength(0.2))
  {
    step(LIGHT);
    ASSERT_TRUE(alone.step(within.stamp()));
    ASSERT_NEAR(within.outputs().output_angle, alone.outputs().output_angle, 0.02 * LEAST_TORSION);
    torsion = std::max(torsion, std::abs(within.outputs().output_angle - within.outputs().motor_angle / 101.0));
  }
  EXPECT_GT(torsion, LEAST_TORSION);
  EXPECT_LE(3 * within.outputs().substeps, alone.outputs().substeps);
  while (within.stamp() < toStampLength(0.3))
  {
    step(0.5);
    // Other substeps, other ends of the kicks: the ledger closes all the same.
    ASSERT_NEAR(within.outputs().energy_residual, 0.0, 1e-5) << toSeconds(within.stamp());
  }
  EXPECT_EQ(within.outputs().substeps, 1U);
}

TEST(ArmTwin, FrameAndGravityTurnedTogetherChangeNothing)
{
  const auto angles = [](const std::string& rpy, const std::array<double, 3>& gravity)
  {
    ArmDescription description = rods("0 1 0", 2);
    description.urdf = urdf("0 1 0", 2, rpy);
    readLinks(description);
    description.gravity = gravity;
    ArmTwin arm(description, { drive(), drive() }, { 0.3, -0.8 });
    run(arm, 0.1);
    return std::array<double, 2>{ arm.motion()[0].position, arm.motion()[1].position };
  };
  const std::array<double, 2> upright = angles("0 0 0", { 0.0, 0.0, -9.81 });
  const std::array<double, 2> hanging = angles("3.141592653589793 0 0", { 0.0, 0.0, 9.81 });
  EXPECT_NEAR(upright[0], hanging[0], 1e-9);
  EXPECT_NEAR(upright[1], hanging[1], 1e-9);
}

TEST(ArmTwin, StandsInItsBrakesAsItHangs)
{
  ArmTwin arm(rods("0 1 0", 2), { drive(), drive() }, { 0.3, -0.8 });
  for (int i = 0; i < 1000; ++i)
  {
    ASSERT_TRUE(arm.step(toStampLength(1.0)));
  }
  constexpr double CREEP = 2e-6;  // of an output that regularised friction holds, in this time [rad]
  EXPECT_NEAR(arm.motion()[0].position, 0.3, CREEP);
  EXPECT_NEAR(arm.motion()[1].position, -0.8, CREEP);
  // Weight of both rods about the first joint.
  const double torque = 9.81 * (4.0 * 0.3 * std::cos(0.3) + 2.0 * (0.5 * std::cos(0.3) + 0.3 * std::cos(-0.5)));
  EXPECT_NEAR(std::abs(arm.drive(0).linkTorque()), torque, CREEP * arm.drive(0).outputs().torsional_stiffness);
}

/// Two joints that go to and fro within a second.
ArmMotion swing(bool repeats)
{
  std::vector<ArmSetPoint> points;
  for (const double way : { 0.0, 0.1, 0.0 })
  {
    points.push_back(
        { 0.5 * static_cast<double>(points.size()), { { 0.3 + way, 0.0, 0.0 }, { -0.8 - way, 0.0, 0.0 } } });
  }
  return ArmMotion(points, ArmAccelerations::OF_CUBICS, repeats);
}

TEST(ArmMotion, RatesAreThoseOfItsAngles)
{
  constexpr double STEP = 1e-5;
  ArmMotion motion = swing(false);
  std::array<std::vector<JointMotion>, 3> at{ std::vector<JointMotion>(2), std::vector<JointMotion>(2),
                                              std::vector<JointMotion>(2) };
  for (const double time : { 0.1, 0.3, 0.7, 0.95 })
  {
    for (std::size_t k = 0; k < at.size(); ++k)
    {
      motion.at(time + (static_cast<double>(k) - 1.0) * STEP, at[k]);
    }
    EXPECT_NEAR(at[1][0].velocity, (at[2][0].position - at[0][0].position) / (2.0 * STEP), 1e-8);
    EXPECT_NEAR(at[1][0].acceleration, (at[2][0].velocity - at[0][0].velocity) / (2.0 * STEP), 1e-8);
  }
}

TEST(ArmMotion, RepeatsOrStandsStillAtItsEnd)
{
  std::vector<JointMotion> at(2);
  std::vector<JointMotion> later(2);
  ArmMotion repeated = swing(true);
  repeated.at(0.3, at);
  repeated.at(7.3, later);
  EXPECT_NEAR(later[0].position, at[0].position, 1e-12);
  EXPECT_NEAR(later[1].velocity, at[1].velocity, 1e-12);
  swing(false).at(7.3, later);
  EXPECT_EQ(later[0].position, 0.3);
  EXPECT_EQ(later[0].velocity, 0.0);
}

TEST(MovingArm, GoesToAnotherMotionFromWhereItIs)
{
  constexpr double NEAR = 2e-3;  // of a set point [rad]
  const ArmDescription description = rods("0 1 0", 2);
  MovingArm arm(description, { drive(), drive() }, swing(true), {});
  const auto expect_followed = [&](double until)
  {
    std::vector<JointMotion> wanted(2);
    while (arm.step(toStampLength(until)))
    {
      arm.wanted(wanted);
      ASSERT_NEAR(arm.twin().motion()[0].position, wanted[0].position, NEAR) << toSeconds(arm.twin().stamp());
      ASSERT_NEAR(arm.twin().motion()[1].position, wanted[1].position, NEAR) << toSeconds(arm.twin().stamp());
    }
  };
  expect_followed(MovingArm::SETTLING + 0.3);
  ArmMotion other({ { 0.0, { {}, {} } }, { 0.4, { { 0.5, 0.0, 0.0 }, { -1.0, 0.0, 0.0 } } } },
                  ArmAccelerations::OF_CUBICS);
  const std::size_t before = allocationCount();
  arm.follow(other);
  EXPECT_EQ(allocationCount(), before);
  expect_followed(MovingArm::SETTLING + 0.8);
  EXPECT_NEAR(arm.twin().motion()[0].position, 0.5, NEAR);
  EXPECT_NEAR(arm.reading(1).position, -1.0, NEAR);
  ASSERT_TRUE(arm.reset(0));
  EXPECT_EQ(arm.twin().motion()[0].position, 0.3);
  expect_followed(MovingArm::SETTLING + 0.1);
}

TEST(MovingArm, StopsWhereItCannotFollow)
{
  MovingArm arm(rods("0 1 0", 2), { drive(), drive() },
                ArmMotion({ { 0.0, { { 0.3, 0.0, 0.0 }, { -0.8, 0.0, 0.0 } } },
                            { 0.1, { { 0.3, 0.0, 0.0 }, { -0.8, 0.0, 0.0 } } },
                            { 0.101, { { 0.3, 0.0, 0.0 }, { -0.6, 0.0, 0.0 } } } }),
                {});
  const auto run_to = [&](double time)
  {
    while (arm.step(toStampLength(time)))
    {
    }
  };
  run_to(MovingArm::SETTLING + 0.1);
  EXPECT_FALSE(arm.protectiveStop());
  const std::size_t before = allocationCount();
  run_to(MovingArm::SETTLING + 0.3);
  EXPECT_EQ(allocationCount(), before);
  ASSERT_TRUE(arm.protectiveStop());
  EXPECT_EQ(arm.protectiveStop()->joint, 1U);
  EXPECT_NEAR(toSeconds(arm.protectiveStop()->stamp), MovingArm::SETTLING + 0.1005, 1e-3);
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_TRUE(arm.twin().drive(i).outputs().brake_engaged);
    EXPECT_EQ(arm.twin().drive(i).outputs().motor_velocity, 0.0);
    EXPECT_EQ(arm.twin().drive(i).counters().command_timeouts, 0U);  // no torque is a command too
  }
  EXPECT_NEAR(arm.twin().motion()[1].position, -0.8, 0.1);
  ASSERT_TRUE(arm.reset(0));
  EXPECT_FALSE(arm.protectiveStop());
}

/// It goes on from where a push has left it.
TEST(MovingArm, IsUnlockedInPlace)
{
  MovingArm arm(rods("0 1 0", 2), { drive(), drive() },
                ArmMotion({ { 0.0, { { 0.3, 0.0, 0.0 }, { -0.8, 0.0, 0.0 } } } }), {});
  const auto run_for = [&](double time)
  {
    const Stamp end = arm.twin().stamp() + toStampLength(time);
    while (arm.step(end))
    {
    }
  };
  run_for(MovingArm::SETTLING);
  EXPECT_TRUE(arm.unlock());  // there is nothing to unlock
  arm.twin().setWrench({ { 3000.0, 0.0, -3000.0 }, {} });
  while (!arm.protectiveStop() && toSeconds(arm.twin().stamp()) < 2.0)
  {
    run_for(1e-3);
  }
  arm.twin().setWrench({});
  ASSERT_TRUE(arm.protectiveStop());
  EXPECT_FALSE(arm.unlock());
  EXPECT_TRUE(arm.protectiveStop());
  double waited = 0.0;
  while (!arm.unlock() && waited < 10.0)  // in its brakes it swings
  {
    EXPECT_TRUE(arm.protectiveStop());
    run_for(0.1);
    waited += 0.1;
  }
  const std::vector<JointMotion> stood = arm.twin().motion();
  EXPECT_GT(std::abs(stood[0].position - 0.3) + std::abs(stood[1].position + 0.8), 0.05);
  EXPECT_FALSE(arm.protectiveStop()) << waited;
  run_for(0.3);
  ASSERT_FALSE(arm.protectiveStop());
  std::vector<ArmSetPoint> way{ { 0.0, stood }, { 0.5, { { 0.3, 0.0, 0.0 }, { -0.8, 0.0, 0.0 } } } };
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_FALSE(arm.twin().drive(i).outputs().brake_engaged);
    EXPECT_NEAR(arm.twin().motion()[i].position, stood[i].position, 2e-3);
  }
  ArmMotion back(way, ArmAccelerations::OF_CUBICS);
  arm.follow(back);
  run_for(1.0);
  EXPECT_FALSE(arm.protectiveStop());
  EXPECT_NEAR(arm.twin().motion()[0].position, 0.3, 2e-3);
  EXPECT_NEAR(arm.twin().motion()[1].position, -0.8, 2e-3);
}

TEST(SampleMoves, LimitedJerkKeepsTheWayAndEveryLimit)
{
  constexpr double PERIOD = 1e-4;
  for (const double way : { 0.002, 0.05, 1.5 })  // acceleration not reached, reached, speed reached
  {
    const ArmMove move{ { way }, 1.0, 4.0, 40.0, 0.0 };
    ArmDescription arm = rods("0 0 1", 1);
    const std::vector<ArmInstant> instants = sampleMoves(arm, { 0.0 }, { move }, PERIOD);
    EXPECT_EQ(instants.front().joints[0].position, 0.0);
    EXPECT_EQ(instants.back().joints[0].position, way);
    for (std::size_t k = 1; k < instants.size(); ++k)
    {
      const JointMotion& before = instants[k - 1].joints[0];
      const JointMotion& now = instants[k].joints[0];
      ASSERT_LE(now.velocity, move.speed * (1.0 + 1e-9));
      ASSERT_LE(std::abs(now.acceleration), move.acceleration * (1.0 + 1e-9));
      ASSERT_LE(std::abs(now.acceleration - before.acceleration), move.jerk * PERIOD * (1.0 + 1e-6));
      // Trapezoidal rule: a jerk that jumps leaves half of itself times the square of the period.
      ASSERT_NEAR(now.position - before.position, 0.5 * PERIOD * (now.velocity + before.velocity),
                  move.jerk * PERIOD * PERIOD * PERIOD);
      ASSERT_NEAR(now.velocity - before.velocity, 0.5 * PERIOD * (now.acceleration + before.acceleration),
                  move.jerk * PERIOD * PERIOD);
    }
  }
}

TEST(ArmTwin, AllocatesNothingInAStep)
{
  ArmTwin arm(rods("0 1 0", 2), { drive(), drive() }, { 0.3, -0.8 });
  arm.step(toStampLength(1.0));
  const std::size_t before = allocationCount();
  for (int i = 0; i < 100; ++i)
  {
    arm.step(toStampLength(1.0));
  }
  EXPECT_EQ(allocationCount(), before);
}

TEST(ArmTwin, RefusesWhatDoesNotFit)
{
  const auto message = [](std::vector<Parameters> drives, double mass_rate = 1000.0) {
    return complaintOf([&] { ArmTwin(rods("0 1 0", 2), std::move(drives), { 0.0, 0.0 }, {}, { mass_rate, 1 }); });
  };
  EXPECT_THAT(message({ drive() }), testing::HasSubstr("has 2 joints"));
  EXPECT_THAT(message({ drive(), drive(5e3) }), testing::HasSubstr("joint_1: solver.rate = 5000.0 Hz"));
  Parameters heavy = drive();
  heavy.output.gravity_torque = 3.0;
  EXPECT_THAT(message({ heavy, drive() }), testing::HasSubstr("joint_0: output.gravity_torque = 3.0"));
  EXPECT_THAT(message({ drive(), drive() }, 2e4), testing::HasSubstr("mass matrix"));
}
}  // namespace
}  // namespace hjt
