// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/twin.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
/// Every output of a run with all inputs known from the start.
std::vector<std::vector<double>> record(Twin& twin, const std::vector<Input>& inputs, Stamp duration)
{
  for (const Input& input : inputs)
  {
    give(twin, input);
  }
  std::vector<std::vector<double>> rows;
  while (twin.step(duration))
  {
    rows.push_back(numbers(twin.outputs()));
  }
  return rows;
}

TEST(TwinRepeats, TheSameInputsGiveTheSameBits)
{
  const std::vector<Input> inputs = randomInputs(81, SECOND / 2, 1.5, 60.0);
  Twin first(shippedParameters());
  Twin second(shippedParameters());
  const auto rows = record(first, inputs, SECOND / 2);
  ASSERT_EQ(rows.size(), 5000U);
  EXPECT_TRUE(rows == record(second, inputs, SECOND / 2));
}

std::vector<double> withoutStamp(const JointOutputs& outputs)
{
  std::vector<double> values = numbers(outputs);
  values.erase(values.begin());
  return values;
}

/// Braked under load the joint comes to rest and stays as it is, to the last bit; a change of load finds it as if no
/// time had passed, however long it has rested.
TEST(TwinAtRest, StaysAsItIsUntilAnInputChanges)
{
  std::vector<std::vector<std::vector<double>>> runs;
  for (const Stamp rest : { 2 * SECOND, 3 * SECOND })
  {
    Twin twin(shippedParameters());
    twin.commandBrake(0, true);
    twin.commandLoadTorque(0, 30.0);
    advance(twin, 2 * SECOND);
    const std::vector<double> at_rest = withoutStamp(twin.outputs());
    while (twin.step(rest))
    {
      ASSERT_EQ(withoutStamp(twin.outputs()), at_rest);
    }
    EXPECT_NEAR(twin.outputs().joint_torque, 30.0, 0.1 + shippedParameters().cup.friction_torque);
    twin.commandLoadTorque(rest, -10.0);
    std::vector<std::vector<double>> rows;
    while (twin.step(rest + 50 * MILLISECOND))
    {
      rows.push_back(withoutStamp(twin.outputs()));
    }
    EXPECT_NE(rows.front(), at_rest);
    runs.push_back(rows);
  }
  EXPECT_TRUE(runs[0] == runs[1]);
}

/// Friction that is regularised lets the output creep; at no load does that keep it from resting.
TEST(TwinAtRest, ComesAtAnyLoad)
{
  for (const double load : { 0.0, 10.0, 40.0, -40.0, 60.0, 100.0, 150.0 })
  {
    Twin twin(shippedParameters());
    twin.commandBrake(0, true);
    twin.commandLoadTorque(0, load);
    advance(twin, 1500 * MILLISECOND);
    const std::vector<double> at_rest = withoutStamp(twin.outputs());
    advance(twin, 1600 * MILLISECOND);
    EXPECT_EQ(withoutStamp(twin.outputs()), at_rest) << load;
    EXPECT_NEAR(twin.outputs().joint_torque, load, 0.1 + shippedParameters().cup.friction_torque);
  }
}

TEST(TwinRepeats, InChunksOfAnyLength)
{
  const std::vector<Input> inputs = randomInputs(82, SECOND / 2, 1.5, 60.0);
  Twin whole(shippedParameters());
  const auto rows = record(whole, inputs, SECOND / 2);

  // Inputs arrive little by little, each no later than the chunk that it acts in.
  Twin chunked(shippedParameters());
  std::mt19937 random(83);
  std::uniform_int_distribution<Stamp> length(1, 30 * MILLISECOND);
  std::vector<std::vector<double>> pieces;
  std::size_t given = 0;
  for (Stamp until = 0; until < SECOND / 2;)
  {
    until = std::min(until + length(random), SECOND / 2);
    for (; given < inputs.size() && inputs[given].stamp <= until; ++given)
    {
      give(chunked, inputs[given]);
    }
    while (chunked.step(until))
    {
      pieces.push_back(numbers(chunked.outputs()));
    }
  }
  EXPECT_TRUE(rows == pieces);
}

TEST(TwinRepeats, AfterAReset)
{
  const std::vector<Input> inputs = randomInputs(84, SECOND / 2, 2.8, 100.0);
  Twin twin(shippedParameters({}, { "joints/elbow" }));
  const auto rows = record(twin, inputs, SECOND / 2);
  const TwinCounters counters = twin.counters();
  twin.reset(0);
  EXPECT_EQ(twin.stamp(), 0);
  EXPECT_EQ(twin.counters().steps, 0U);
  EXPECT_TRUE(rows == record(twin, inputs, SECOND / 2));
  EXPECT_EQ(twin.counters().torque_clamped, counters.torque_clamped);
  EXPECT_EQ(twin.counters().step_cuts, counters.step_cuts);
}

TEST(TwinReset, StartsAtTheFirstInstantNotBeforeTheStamp)
{
  Twin twin(shippedParameters());
  for (const auto& [stamp, instant] : { std::pair<Stamp, Stamp>{ 0, 0 },
                                        { 1, 100000 },
                                        { 100000, 100000 },
                                        { 1234567890123456789, 1234567890123500000 } })
  {
    twin.reset(stamp);
    EXPECT_EQ(twin.stamp(), instant);
    EXPECT_FALSE(twin.step(instant + 99999));
    EXPECT_TRUE(twin.step(instant + 100000));
    EXPECT_EQ(twin.outputs().stamp, instant + 100000);
  }
}

TEST(TwinReset, RefusesAStampThatNoLengthOfTimeCanBeAddedTo)
{
  Twin twin(shippedParameters());
  advance(twin, MILLISECOND);
  for (const Stamp stamp : { MAX_STAMP + 1, -MAX_STAMP - 1, std::numeric_limits<Stamp>::max() })
  {
    EXPECT_FALSE(twin.reset(stamp));
    EXPECT_EQ(twin.stamp(), MILLISECOND);
    twin.injectFault(stamp, { FaultKind::TOOTH_WEAR, 1.0, 20, 1e9 });
  }
  EXPECT_EQ(twin.counters().faults.refused, 3U);
  EXPECT_EQ(twin.counters().faults.late, 0U);
  twin.injectFault(MAX_STAMP, { FaultKind::TOOTH_WEAR, 1.0, 20, 1e9 });
  EXPECT_EQ(twin.counters().faults.accepted, 1U);
  for (const Stamp stamp : { -MAX_STAMP, MAX_STAMP })
  {
    EXPECT_TRUE(twin.reset(stamp));
    EXPECT_TRUE(twin.step(stamp + MILLISECOND));
  }
}

TEST(TwinReset, ForgetsALoadThatWasTooLarge)
{
  Twin twin(shippedParameters());
  twin.commandLoadTorque(0, 1e6);
  advance(twin, MILLISECOND);
  EXPECT_EQ(twin.counters().load_clamped, 10U);
  EXPECT_EQ(twin.outputs().load_torque, twin.parameters().output.load_torque_limit);
  twin.reset(0);
  advance(twin, MILLISECOND);
  EXPECT_EQ(twin.outputs().load_torque, 0.0);
  EXPECT_EQ(twin.counters().load_clamped, 0U);
}

TEST(TwinInputs, ActFromTheirStampOn)
{
  Twin twin(shippedParameters());
  twin.commandMotorTorque(225000, 1.0);
  twin.commandMotorTorque(300000, 0.5);
  ASSERT_TRUE(twin.step(SECOND) && twin.step(SECOND));
  EXPECT_EQ(twin.outputs().motor_torque, 0.0);
  ASSERT_TRUE(twin.step(SECOND));
  EXPECT_EQ(twin.outputs().stamp, 300000);
  EXPECT_DOUBLE_EQ(twin.outputs().motor_torque, 0.75);  // the mean over the step
  ASSERT_TRUE(twin.step(SECOND));
  EXPECT_EQ(twin.outputs().motor_torque, 0.5);
  EXPECT_EQ(twin.counters().input.late, 0U);
}

TEST(TwinInputs, BetweenInstantsMoveTheMotorAsOnFinerInstants)
{
  // Commands that change at tenths of a millisecond and 37 us, held meanwhile.
  const auto angle = [](const std::string& rate)
  {
    Twin twin(shippedParameters({ rate }));
    for (int i = 0; i < 20; ++i)
    {
      twin.commandMotorTorque(i * MILLISECOND + (i % 2) * 37000, 0.4 + 0.01 * i);
    }
    advance(twin, 20 * MILLISECOND);
    return twin.outputs().motor_angle;
  };
  const double exact = angle("solver.rate=160000");
  EXPECT_GT(exact, 0.1);
  EXPECT_NEAR(angle("solver.rate=10000"), exact, 1e-5);
}

TEST(TwinInputs, LateOnesActAtOnceAndAreCounted)
{
  Twin twin(shippedParameters());
  advance(twin, 10 * MILLISECOND);
  twin.commandMotorTorque(5 * MILLISECOND, 0.5);
  ASSERT_TRUE(twin.step(SECOND));
  EXPECT_EQ(twin.outputs().motor_torque, 0.5);
  EXPECT_EQ(twin.counters().input.late, 1U);
}

TEST(TwinInputs, NotFiniteOnesAreRefusedAndCounted)
{
  Twin twin(shippedParameters());
  Twin untouched(shippedParameters());
  const double infinity = std::numeric_limits<double>::infinity();
  for (Twin* each : { &twin, &untouched })
  {
    each->commandMotorTorque(0, 0.5);
    each->commandLoadTorque(0, 20.0);
  }
  for (const double bad : { std::numeric_limits<double>::quiet_NaN(), infinity, -infinity })
  {
    twin.commandMotorTorque(MILLISECOND, bad);
    twin.commandLoadTorque(MILLISECOND, bad);
  }
  advance(twin, 20 * MILLISECOND);
  advance(untouched, 20 * MILLISECOND);
  EXPECT_EQ(twin.counters().input.not_finite, 6U);
  EXPECT_TRUE(numbers(twin.outputs()) == numbers(untouched.outputs()));
}

TEST(TwinInputs, ACommandTimesOutToZeroTorqueOnce)
{
  Twin twin(shippedParameters());
  twin.commandMotorTorque(0, 0.5);
  advance(twin, 100 * MILLISECOND);
  EXPECT_EQ(twin.outputs().motor_torque, 0.5);
  EXPECT_EQ(twin.counters().command_timeouts, 0U);
  advance(twin, 200 * MILLISECOND);
  EXPECT_EQ(twin.outputs().motor_torque, 0.0);
  EXPECT_EQ(twin.counters().command_timeouts, 1U);
  twin.commandMotorTorque(250 * MILLISECOND, -0.5);
  advance(twin, 260 * MILLISECOND);
  EXPECT_EQ(twin.outputs().motor_torque, -0.5);
  advance(twin, 500 * MILLISECOND);
  EXPECT_EQ(twin.counters().command_timeouts, 2U);
}

TEST(TwinInputs, ACommandFromTheEarliestStampHasTimedOut)
{
  Twin twin(shippedParameters());
  twin.commandMotorTorque(std::numeric_limits<Stamp>::min(), 0.5);
  ASSERT_TRUE(twin.step(SECOND));
  EXPECT_EQ(twin.outputs().motor_torque, 0.0);
  EXPECT_EQ(twin.counters().command_timeouts, 1U);
}

TEST(TwinConstruction, RefusesWhatItCannotRun)
{
  EXPECT_THROW(Twin(shippedParameters({ "contact.law=polar" })), ParameterError);
  EXPECT_THROW(
      Twin(goldenParameters({ "contact.stiffness=1.0e+12", "solver.max_iterations=1", "solver.max_step_cuts=0" })),
      ParameterError);
  EXPECT_THROW(Twin(shippedParameters({ "solver.rate=100", "publish.joint_states_rate=100", "publish.encoders_rate=100",
                                        "indicators.sample_rate=100", "output.load_inertia=0.0" })),
               ParameterError);
  // A light motor on the gear swings as fast as a light output.
  EXPECT_THROW(Twin(shippedParameters({ "motor.rotor_inertia=1.0e-9", "motor.wave_generator_inertia=0.0" })),
               ParameterError);
}

TEST(TwinLoop, DoesNotAllocate)
{
  Twin twin(shippedParameters({ "input.command_timeout=10.0" }));
  ToothForces teeth = twin.makeToothForces();
  const std::vector<Input> inputs = randomInputs(95, SECOND / 5, 1.5, 60.0);
  std::int64_t counts = 0;
  const std::size_t before = allocationCount();
  for (const Input& input : inputs)
  {
    give(twin, input);
  }
  while (twin.step(SECOND / 5))
  {
    twin.toothForces(teeth);
    counts += twin.encoders().motor_count;
    counts += twin.health().lobes.teeth_loaded;
  }
  twin.reset(SECOND);
  EXPECT_EQ(allocationCount(), before);
  EXPECT_NE(counts, 0);
}

TEST(TwinToothForces, GiveEveryToothItsPlace)
{
  Twin twin(shippedParameters());
  advance(twin, MILLISECOND);
  ToothForces teeth = twin.makeToothForces();
  ASSERT_TRUE(twin.toothForces(teeth));
  const GearParameters& gear = twin.parameters().gear;
  for (int i = 0; i < gear.teeth_flexspline; ++i)
  {
    const double angle = TWO_PI * i / gear.teeth_flexspline;
    const double wave = gear.wave_amplitude * std::cos(2.0 * angle);
    const auto at = static_cast<std::size_t>(i);
    EXPECT_NEAR(std::hypot(teeth.tooth_x[at], teeth.tooth_y[at]), gear.flexspline_inner_radius + wave, 5e-5) << i;
    EXPECT_NEAR(std::remainder(std::atan2(teeth.tooth_y[at], teeth.tooth_x[at]) - angle, TWO_PI), 0.0, 0.01) << i;
  }
}

TEST(TwinRunning, MakesItsRatioOutOfTheContacts)
{
  Twin twin(shippedParameters({ "input.command_timeout=10.0" }));
  twin.commandMotorTorque(0, 0.4);
  twin.commandLoadTorque(0, 20.0);
  while (twin.step(10 * SECOND) && twin.outputs().motor_angle < 30.0)
  {
  }
  const HealthReport health = twin.health();
  ASSERT_TRUE(health.motion.transmission_ratio.valid);
  // Over one turn, with the torsion that is left of the start swinging by some 1e-5 of a turn.
  EXPECT_NEAR(health.motion.transmission_ratio.value, 101.0, 0.1);
  EXPECT_NEAR(twin.outputs().motor_angle / twin.outputs().output_angle, 101.0, 1.0);
  EXPECT_EQ(health.solver_state, SolverState::OK);
  EXPECT_GT(health.lobes.teeth_loaded, 4);
  EXPECT_GT(health.lobes.mesh_force[0], 0.0);
  EXPECT_LT(health.lobes.asymmetry, 0.01);
  EXPECT_GT(health.lobes.wave_generator_force, 900.0);
  EXPECT_GT(twin.outputs().friction_torque, twin.parameters().motor.coulomb_torque);
  EXPECT_NEAR(twin.outputs().torsional_stiffness, 50e3, 5e3);
  const EncoderReadings encoders = twin.encoders();
  const double motor_count = TWO_PI / 4320.0;
  EXPECT_NEAR(encoders.motor_angle, twin.outputs().motor_angle, motor_count);
  EXPECT_NEAR(encoders.output_angle, twin.outputs().output_angle, TWO_PI / (1 << 19));
}
}  // namespace
}  // namespace hjt
