// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <functional>
#include <set>

#include <gmock/gmock.h>

#include "arm/arm_configuration.hpp"
#include "arm/arm_controller.hpp"
#include "arm/arm_motion.hpp"
#include "arm/arm_twin.hpp"
#include "arm/set_points.hpp"
#include "gear/ratio.hpp"
#include "test/core/complaint.hpp"
#include "test/core/rods.hpp"
#include "test/support/allocation_count.hpp"
#include "tracking/friction_map.hpp"

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
  EXPECT_NEAR(coarse / fine, 4.0, 0.5);
}

TEST(ArmTwin, AMassMatrixTakenLessOftenCostsInProportion)
{
  const double seldom = couplingError(10e3, 500.0);
  const double often = couplingError(10e3, 1000.0);
  EXPECT_NEAR(seldom / often, 2.0, 0.5);
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

TEST(ArmTwin, StandsInItsBrakesAsItHangsAndAllocatesNothing)
{
  ArmTwin arm(rods("0 1 0", 2), { drive(), drive() }, { 0.3, -0.8 });
  arm.step(toStampLength(1.0));
  const std::size_t before = allocationCount();
  for (int i = 1; i < 1000; ++i)
  {
    ASSERT_TRUE(arm.step(toStampLength(1.0)));
  }
  EXPECT_EQ(allocationCount(), before);
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
  const std::vector<JointMotion> away{ { 0.4, 0.0, 0.0 }, { -0.9, 0.0, 0.0 } };
  return ArmMotion({ { 0.0, REST }, { 0.5, away }, { 1.0, REST } }, ArmAccelerations::OF_CUBICS, repeats);
}

TEST(ArmMotion, RatesAreThoseOfItsAngles)
{
  constexpr double STEP = 1e-5;
  ArmMotion motion = swing(false);
  std::vector<std::vector<JointMotion>> at(3, REST);
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
  MovingArm arm = movingRods(swing(true));
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
  MovingArm arm =
      movingRods(ArmMotion({ { 0.0, REST }, { 0.1, REST }, { 0.101, { { 0.3, 0.0, 0.0 }, { -0.6, 0.0, 0.0 } } } }));
  advance(arm, toStampLength(MovingArm::SETTLING + 0.1));
  EXPECT_FALSE(arm.protectiveStop());
  const std::size_t before = allocationCount();
  advance(arm, toStampLength(MovingArm::SETTLING + 0.3));
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
  MovingArm arm = movingRods(ArmMotion({ { 0.0, REST } }));
  const auto run_for = [&](double time) { advance(arm, arm.twin().stamp() + toStampLength(time)); };
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
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_FALSE(arm.twin().drive(i).outputs().brake_engaged);
    EXPECT_NEAR(arm.twin().motion()[i].position, stood[i].position, 2e-3);
  }
  ArmMotion back({ { 0.0, stood }, { 0.5, REST } }, ArmAccelerations::OF_CUBICS);
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

/// Of every shipped arm: beyond a limit it throws.
TEST(GentleMotion, TakesEveryJointBothWaysSlowlyAndFast)
{
  for (const char* name : { "ur3", "ur3e", "ur5", "ur5e", "ur10", "ur10e", "ur15", "ur16e", "ur18", "ur8long" })
  {
    const ArmDescription arm = readArmDescription(findArm(name, HJT_TEST_CONFIG_DIR));
    const ArmMotion motion = gentleMotion(arm);
    for (std::size_t i = 0; i < arm.joints.size(); ++i)
    {
      double slowest = 0.0;
      double fastest = 0.0;
      for (const ArmSetPoint& point : motion.points())
      {
        slowest = std::min(slowest, point.joints[i].velocity);
        fastest = std::max(fastest, point.joints[i].velocity);
      }
      EXPECT_GT(fastest, 0.6) << name << ' ' << i;
      EXPECT_LT(slowest, -0.6) << name << ' ' << i;
      EXPECT_NEAR(motion.points().front().joints[i].position, motion.points().back().joints[i].position, 1e-12);
    }
  }
}

/// The scene is chosen for a joint whose files leave it as shipped, and for that alone.
TEST(ArmDriveMaps, AJointsOwnSceneCounts)
{
  ArmDescription arm = readArmDescription(findArm("ur5", HJT_TEST_CONFIG_DIR));
  arm.joints[2].parameters["solver.scene"] = { std::string("full_ring"), "the arm's file" };
  ConfigurationOptions options;
  options.config_dir = HJT_TEST_CONFIG_DIR;
  const auto scene_of = [&](std::size_t joint)
  { return parseParameters(armDriveMaps(arm, options, "")[joint]).solver.scene; };
  EXPECT_EQ(scene_of(2), SceneKind::FULL_RING);
  EXPECT_EQ(scene_of(1), SceneKind::AUTO);
  options.assignments = { "solver.scene=full_ring" };
  EXPECT_EQ(scene_of(1), SceneKind::FULL_RING);
}

/// A motor may hold more than its gear bears: those loads are left out.
TEST(FrictionMap, IsMadeForEveryDriveOfEveryShippedArm)
{
  std::set<std::vector<std::string>> seen;
  for (const char* name : { "ur3", "ur3e", "ur5", "ur5e", "ur10", "ur10e", "ur15", "ur16e", "ur18", "ur8long" })
  {
    for (const ArmJoint& joint : readArmDescription(findArm(name, HJT_TEST_CONFIG_DIR)).joints)
    {
      if (seen.insert(joint.overlays).second)
      {
        const Parameters parameters = parseParameters(armJointParameters(joint, HJT_TEST_CONFIG_DIR, ""));
        const FrictionMap map(parameters);
        const double bears = parameters.output.load_torque_limit;
        EXPECT_GT(map.at(10.0, 0.8 * bears, 25.0).sum(), map.at(10.0, 0.0, 25.0).sum()) << name << joint.short_name;
      }
    }
  }
}

TEST(GiveOwnSeeds, NoDriveIsAnotherAndPerfectOnesStayAlike)
{
  std::vector<Parameters> drives(6, shippedParameters());
  giveOwnSeeds(drives);
  EXPECT_EQ(drives[5].manufacture.circular_spline_pitch.seed, drives[0].manufacture.circular_spline_pitch.seed);
  for (Parameters& each : drives)
  {
    each.manufacture.flexspline_pitch.deviation = 4e-6;
    each.manufacture.circular_spline_pitch.deviation = 9.5e-6;
  }
  giveOwnSeeds(drives);
  std::set<int> seeds;
  for (const Parameters& each : drives)
  {
    seeds.insert({ each.manufacture.flexspline_pitch.seed, each.manufacture.circular_spline_pitch.seed });
  }
  EXPECT_EQ(seeds.size(), 12U);
}

using testing::HasSubstr;

/// Two rods that turn about the vertical, so that nothing but inertia counts; the first joint goes that far in a tenth
/// of a second, at an acceleration of 600 times the way at both ends.
std::string errorsOf(const ArmDescription& arm, double way, const Payload& payload = {})
{
  MotionLimits limits(arm, { drive(), drive() });
  limits.setPayload(payload);
  return limits.errors({ { 0.0, { {}, {} } }, { 0.1, { { way, 0.0, 0.0 }, {} } } });
}

TEST(MotionLimits, HoldOfLinksAndOfTheMotor)
{
  ArmDescription arm = rods("0 0 1", 2);
  ArmDynamics dynamics(arm);
  std::vector<double> torques(2);
  dynamics.torques({ { 0.0, 0.0, 1.0 }, {} }, torques);
  const double inertia = torques[0];
  const double motor_limit = nominalRatio(drive().gear) * drive().motor.torque_limit;
  const double most = motor_limit / (inertia + ArmController::motorInertia(drive())) / 600.0;
  EXPECT_EQ(errorsOf(arm, 0.99 * most), "");
  EXPECT_THAT(errorsOf(arm, 1.01 * most), HasSubstr("joint_0 would need"));
  EXPECT_THAT(errorsOf(arm, 1.01 * most), HasSubstr("N.m of its motor before 0.1 s, at"));
  EXPECT_THAT(errorsOf(arm, -1.01 * most), HasSubstr("N.m of its motor"));
  // What the joint may bear is less here.
  arm.joints[0].torque_limit = 0.5 * inertia * most * 600.0;
  EXPECT_EQ(errorsOf(arm, 0.49 * most), "");
  EXPECT_THAT(errorsOf(arm, 0.51 * most), HasSubstr("its limit is"));
  // A payload needs torque too.
  EXPECT_THAT(errorsOf(arm, 0.49 * most, { 5.0, { 0.1, 0.0, 0.0 } }), HasSubstr("its limit is"));
}
}  // namespace
}  // namespace hjt
