// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "gear/angle.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
/// A rim that gives way under flat flanks: its teeth jump below 250 N.m.
const std::vector<std::string> SOFT_GEAR{
  "contact.stiffness=1.0e+6",       "ring.tension_stiffness=5.0e+7",   "mesh.flank_angle=1.0",
  "mesh.engagement_depth=200.0e-6", "output.load_torque_limit=1000.0", "input.command_timeout=10.0"
};

TEST(TwinFailure, HoldsTheLastGoodStateAndRecovers)
{
  // Where a tooth jumps there is no equilibrium near; one iteration and no shorter path leave no way across.
  std::vector<std::string> assignments = SOFT_GEAR;
  assignments.insert(assignments.end(), { "solver.max_iterations=1", "solver.max_step_cuts=0" });
  Twin twin(goldenParameters(assignments));
  twin.commandLoadTorque(MILLISECOND, 600.0);
  twin.commandLoadTorque(100 * MILLISECOND, 0.0);
  JointOutputs good = twin.outputs();
  std::uint64_t failures = 0;
  while (twin.step(100 * MILLISECOND - 1))
  {
    const JointOutputs& now = twin.outputs();
    ASSERT_TRUE(allFinite(numbers(now))) << twin.stamp();
    if (now.converged)
    {
      good = now;
      continue;
    }
    ++failures;
    ASSERT_EQ(now.motor_angle, good.motor_angle);
    ASSERT_EQ(now.output_angle, good.output_angle);
    ASSERT_EQ(now.joint_torque, good.joint_torque);
    ASSERT_EQ(now.motor_velocity, 0.0);
    ASSERT_EQ(now.output_velocity, 0.0);
  }
  EXPECT_GT(failures, 0U);
  EXPECT_EQ(twin.counters().solver_failures, failures);
  EXPECT_EQ(twin.health().solver_state, SolverState::FAILED);
  // The load gone, it finds its way back and stays there, once its swing has died down so far that no step of it is
  // beyond one iteration: each failure stops it where it is strained, and it swings again.
  advance(twin, 600 * MILLISECOND);
  const std::uint64_t before = twin.counters().solver_failures;
  advance(twin, 800 * MILLISECOND);
  EXPECT_EQ(twin.counters().solver_failures, before);
  EXPECT_EQ(twin.health(600 * MILLISECOND).solver_state, SolverState::OK);
  EXPECT_EQ(twin.health().solver_state, SolverState::FAILED);
}

TEST(TwinFailure, IsSaidOfARestartUnderMoreThanTheTeethBear)
{
  Twin twin(goldenParameters());
  twin.coupleArm(1.0, 1e5);
  ASSERT_TRUE(twin.reset(SECOND));
  EXPECT_FALSE(twin.outputs().converged);
  EXPECT_EQ(twin.counters().solver_failures, 1U);
  EXPECT_EQ(twin.health().solver_state, SolverState::FAILED);
  EXPECT_TRUE(allFinite(numbers(twin.outputs())));
  twin.coupleArm(1.0, 50.0);
  ASSERT_TRUE(twin.reset(SECOND));
  EXPECT_TRUE(twin.outputs().converged);
  EXPECT_EQ(twin.counters().solver_failures, 0U);
  EXPECT_EQ(twin.health().solver_state, SolverState::OK);
}

using ViolentRun = testing::TestWithParam<unsigned>;
INSTANTIATE_TEST_SUITE_P(Seeds, ViolentRun, testing::Values(91U, 92U, 93U));

TEST_P(ViolentRun, StaysFiniteEverywhere)
{
  // Loads of up to 1000 N.m and full motor torque to and fro.
  Twin twin(goldenParameters(SOFT_GEAR));
  ToothForces teeth = twin.makeToothForces();
  give(twin, randomInputs(GetParam(), SECOND / 5, 4.0, 1000.0));
  double torsion = 0.0;
  while (twin.step(SECOND / 5))
  {
    ASSERT_TRUE(allFinite(numbers(twin.outputs()))) << twin.stamp();
    torsion = std::max(torsion, std::abs(twin.outputs().motor_angle / 101.0 - twin.outputs().output_angle));
    if (twin.counters().steps % 10 == 0)
    {
      twin.toothForces(teeth);
      for (const std::vector<double>* values : { &teeth.wave_generator_force, &teeth.rim_tension, &teeth.bending_force,
                                                 &teeth.mesh_force, &teeth.tooth_x, &teeth.tooth_y })
      {
        ASSERT_TRUE(allFinite(*values)) << twin.stamp();
      }
      const HealthReport health = twin.health();
      ASSERT_TRUE(allFinite({ health.motion.transmission_ratio.value, health.motion.torsion,
                              health.motion.torsional_stiffness.value, health.motion.efficiency.value,
                              health.motion.kinematic_error.value, health.lobes.mesh_force[0],
                              health.lobes.mesh_force[1], health.lobes.asymmetry, health.lobes.wave_generator_force }))
          << twin.stamp();
    }
  }
  // Further than a pitch of the circular spline: teeth have jumped.
  EXPECT_GT(torsion, TWO_PI / 202.0);
}

TEST(ViolentRunOfTheShippedJoint, ConvergesInEveryStepAndLosesNoEnergy)
{
  // Motor torque to and fro between its limits, loads up to the joint's 150 N.m, the brake thrown in at full speed.
  for (const unsigned seed : { 71U, 72U, 73U })
  {
    Twin twin(goldenParameters({ "input.command_timeout=10.0" }));
    give(twin, randomInputs(seed, SECOND / 2, 2.87, 150.0));
    while (twin.step(SECOND / 2))
    {
      ASSERT_TRUE(twin.outputs().converged) << "seed " << seed << " at " << twin.stamp();
      // Some hundred joules go through; a ring that falls into another equilibrium loses tens of them at once.
      ASSERT_LT(std::abs(twin.outputs().energy_residual), 0.5) << "seed " << seed << " at " << twin.stamp();
    }
  }
}
/// Steps of the twin up to `until` in which something is said of the solver.
TwinCounters countersAfter(Twin& twin, Stamp until)
{
  while (twin.step(until))
  {
    EXPECT_TRUE(allFinite(numbers(twin.outputs()))) << twin.stamp();
  }
  return twin.counters();
}

TEST(DoubtfulStep, IsSaidWhenItIsTooLongForTheSwing)
{
  // The joint swings with 280 rad/s, 0.028 rad of phase in 1e-4 s; on a shaft that gives way with up to 1300 under a
  // load that presses the bearing, more than the unloaded joint shows when the step is divided.
  Twin fine(goldenParameters());
  EXPECT_EQ(countersAfter(fine, 20 * MILLISECOND).coarse_steps, 0U);
  EXPECT_EQ(fine.health().solver_state, SolverState::OK);
  EXPECT_NEAR(fine.outputs().phase_advance, 0.028, 0.001);
  EXPECT_EQ(fine.outputs().substeps, 1U);
  Twin coarse(goldenParameters({ "motor.presliding_angle=1.2e-3", "input.temperature=0.0" }));
  coarse.commandLoadTorque(0, 150.0);
  EXPECT_GT(countersAfter(coarse, 20 * MILLISECOND).coarse_steps, 20U);
  EXPECT_EQ(coarse.health().solver_state, SolverState::DEGRADED);
  EXPECT_EQ(coarse.outputs().substeps, 1U);
}

TEST(DoubtfulStep, IsDividedWhereTheParametersSaySo)
{
  Twin coarse(goldenParameters({ "solver.rate=1000", "indicators.sample_rate=1000" }));
  EXPECT_EQ(countersAfter(coarse, 20 * MILLISECOND).coarse_steps, 0U);
  EXPECT_EQ(coarse.health().solver_state, SolverState::OK);
  EXPECT_EQ(coarse.outputs().substeps, 11U);
  EXPECT_NEAR(coarse.outputs().phase_advance, 0.28 / 11.0, 0.002);
}

TEST(SpeedLimit, IsHeldHoweverStiffly)
{
  // The drive gives its torque up within 0.2 rad/s, by 35 times the motor's momentum there in a step.
  const std::vector<std::string> stiff{ "motor.torque_limit=12.0", "motor.speed_limit=10.0" };
  // A lag overshoots for less than a step.
  for (const auto& [bandwidth, error] : { std::pair("0.0", 4e-3), std::pair("2000.0", 2e-2) })
  {
    std::vector<std::string> drive = stiff;
    drive.push_back(std::string("motor.current_bandwidth=") + bandwidth);
    Twin twin(goldenParameters(drive));
    drive.emplace_back("solver.rate=1.0e+5");
    Twin fine(goldenParameters(drive));
    twin.commandMotorTorque(0, 12.0);
    fine.commandMotorTorque(0, 12.0);
    const TwinCounters counters = countersAfter(twin, 80 * MILLISECOND);
    countersAfter(fine, 80 * MILLISECOND);
    EXPECT_GT(counters.speed_limited, 600U);
    EXPECT_EQ(counters.coarse_steps, 0U);
    EXPECT_GT(twin.outputs().motor_velocity, 9.8);
    EXPECT_LT(twin.outputs().motor_velocity, 10.0);
    EXPECT_NEAR(twin.outputs().motor_angle, fine.outputs().motor_angle, error) << bandwidth;
  }
}

TEST(DoubtfulStep, IsSaidWhenTeethJump)
{
  Twin healthy(goldenParameters());
  healthy.commandMotorTorque(0, 2.87);
  EXPECT_EQ(countersAfter(healthy, 90 * MILLISECOND).jumps, 0U);
  EXPECT_GT(healthy.outputs().motor_velocity, 250.0);
  Twin soft(goldenParameters(SOFT_GEAR));
  soft.commandLoadTorque(0, 600.0);
  EXPECT_GT(countersAfter(soft, 90 * MILLISECOND).jumps, 0U);
  EXPECT_NE(soft.health().solver_state, SolverState::OK);
}

TEST(FreeOutput, WithoutAWaveStaysFinite)
{
  // Nothing slips in a joint whose ring is round: terms of friction without a slip once divided zero by zero.
  Twin twin(goldenParameters({ "gear.wave_amplitude=0.0" }));
  twin.commandMotorTorque(0, 1.0);
  twin.commandLoadTorque(0, -0.1);
  EXPECT_EQ(countersAfter(twin, 20 * MILLISECOND).solver_failures, 0U);
  EXPECT_GT(twin.outputs().motor_velocity, 50.0);
  EXPECT_GT(twin.outputs().output_velocity, 0.0);
}

TEST(FaultyTeeth, CarryNothingAndTheTwinSaysNothing)
{
  Parameters parameters = goldenParameters();
  for (const int tooth : { 0, 1, 199 })
  {
    parameters.faults.push_back({ FaultKind::TOOTH_ROOT_CRACK, 1.0, tooth, 0.0 });
  }
  Twin twin(parameters);
  twin.commandLoadTorque(0, 20.0);
  twin.commandBrake(0, true);
  EXPECT_EQ(countersAfter(twin, 20 * MILLISECOND).solver_failures, 0U);
  ToothForces teeth = twin.makeToothForces();
  twin.toothForces(teeth);
  EXPECT_EQ(teeth.mesh_force[0], 0.0);
  EXPECT_EQ(teeth.mesh_force[1], 0.0);
  EXPECT_EQ(teeth.mesh_force[199], 0.0);
  EXPECT_NE(teeth.mesh_force[2], 0.0);
}
}  // namespace
}  // namespace hjt
