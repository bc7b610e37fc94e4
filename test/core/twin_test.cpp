// SPDX-License-Identifier: BSD-3-Clause

#include <limits>
#include <memory>
#include <utility>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/twin/input_queue.hpp"
#include "test/core/test_parameters.hpp"
#include "test/core/twin_runs.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
/// Every output of a run with all inputs known from the start.
std::vector<std::vector<double>> record(Twin& twin, const std::vector<Input>& inputs, Stamp duration)
{
  give(twin, inputs);
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
  const auto all_rows = record(whole, inputs, SECOND / 2);

  // Inputs arrive little by little, each no later than the chunk that it acts in.
  Twin chunked(shippedParameters());
  SeededRandom random(83);
  std::uniform_int_distribution<Stamp> length(1, 30 * MILLISECOND);
  std::vector<std::vector<double>> pieces;
  auto given = inputs.begin();
  for (Stamp until = 0; until < SECOND / 2;)
  {
    until = std::min(until + length(random), SECOND / 2);
    const auto later = std::find_if(given, inputs.end(), [&](const Input& input) { return input.stamp > until; });
    const auto rows = record(chunked, { given, later }, until);
    pieces.insert(pieces.end(), rows.begin(), rows.end());
    given = later;
  }
  EXPECT_TRUE(all_rows == pieces);
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

/// Late ones at once, and counted.
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
  twin.commandMotorTorque(350000, 0.7);
  ASSERT_TRUE(twin.step(SECOND));
  EXPECT_EQ(twin.outputs().motor_torque, 0.7);
  EXPECT_EQ(twin.counters().input.late, 1U);
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

TEST(TwinInputs, NotFiniteOnesAreRefusedAndCounted)
{
  std::vector<Input> inputs{ { 0, InputKind::MOTOR_TORQUE, 0.5 }, { 0, InputKind::LOAD_TORQUE, 20.0 } };
  Twin untouched(shippedParameters());
  const auto rows = record(untouched, inputs, 20 * MILLISECOND);
  for (const double bad : { std::nan(""), HUGE_VAL, -HUGE_VAL })
  {
    inputs.push_back({ MILLISECOND, InputKind::MOTOR_TORQUE, bad });
    inputs.push_back({ MILLISECOND, InputKind::LOAD_TORQUE, bad });
  }
  Twin twin(shippedParameters());
  EXPECT_TRUE(record(twin, inputs, 20 * MILLISECOND) == rows);
  EXPECT_EQ(twin.counters().input.not_finite, 6U);
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
  Twin earliest(shippedParameters());
  earliest.commandMotorTorque(std::numeric_limits<Stamp>::min(), 0.5);
  ASSERT_TRUE(earliest.step(SECOND));
  EXPECT_EQ(earliest.outputs().motor_torque, 0.0);
  EXPECT_EQ(earliest.counters().command_timeouts, 1U);
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
  while (twin.outputs().motor_angle < 30.0)
  {
    ASSERT_TRUE(twin.step(10 * SECOND));
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

TEST(TwinDrive, HoldsItsSpeedLimit)
{
  Twin twin(shippedParameters({ "input.command_timeout=10.0" }));
  twin.commandMotorTorque(0, 2.87);
  double highest = 0.0;
  while (twin.step(SECOND))
  {
    highest = std::max(highest, twin.outputs().motor_velocity);
  }
  const double limit = twin.parameters().motor.speed_limit;
  EXPECT_GT(twin.counters().speed_limited, 1000U);
  EXPECT_NEAR(twin.outputs().motor_velocity, limit, 0.02 * limit);
  // The output swings while the motor gets up to speed, and pushes the rotor some way beyond.
  EXPECT_LT(highest, 1.1 * limit);
}

TEST(TwinBrake, HoldsBelowItsTorqueAndSlipsAboveIt)
{
  const Parameters parameters =
      shippedParameters({ "motor.torque_limit=20.0", "input.command_timeout=10.0", "output.load_torque_limit=1000.0" });
  Twin twin(parameters);
  twin.commandBrake(0, true);
  twin.commandMotorTorque(0, 0.9 * parameters.brake.holding_torque);
  advance(twin, 200 * MILLISECOND);
  EXPECT_TRUE(twin.outputs().brake_engaged);
  // Stuck, friction still lets the shaft creep at the speed it is regularised at, 1e-6 rad/s, a few times over.
  EXPECT_LT(std::abs(twin.outputs().motor_angle), 1e-6);
  twin.commandMotorTorque(200 * MILLISECOND, 1.3 * parameters.brake.holding_torque);
  advance(twin, 300 * MILLISECOND);
  EXPECT_GT(twin.outputs().motor_angle, 1.0);
  twin.commandBrake(300 * MILLISECOND, false);
  advance(twin, 301 * MILLISECOND);
  EXPECT_FALSE(twin.outputs().brake_engaged);
}

TEST(TwinBrake, LeavesTheShaftItsPlay)
{
  constexpr double PLAY = 0.4;
  Twin twin(shippedParameters({ "brake.play=0.4", "brake.engaged_at_start=true", "input.command_timeout=10.0" }));
  Stamp time = 0;
  for (const double torque : { 0.3, -0.3, 0.3 })
  {
    twin.commandMotorTorque(time, torque);
    time += 500 * MILLISECOND;
    advance(twin, time);
    // It stops within the step in which it meets the pin.
    EXPECT_NEAR(twin.outputs().motor_angle, std::copysign(0.5 * PLAY, torque), 0.02);
    EXPECT_LT(std::abs(twin.outputs().motor_velocity), 1e-6);
  }
}

TEST(TwinBrake, ActsAfterItsDelay)
{
  Twin twin(shippedParameters({ "brake.delay=20.0e-3", "input.command_timeout=10.0" }));
  twin.commandBrake(10 * MILLISECOND, true);
  advance(twin, 30 * MILLISECOND);
  EXPECT_FALSE(twin.outputs().brake_engaged);
  advance(twin, 30 * MILLISECOND + twin.stepLength());
  EXPECT_TRUE(twin.outputs().brake_engaged);
  // One that is given again, as in a loop, is no other.
  Twin told_often(shippedParameters({ "brake.delay=20.0e-3", "input.command_timeout=10.0" }));
  for (Stamp time = 10; time <= 31; ++time)
  {
    told_often.commandBrake(time * MILLISECOND, true);
    advance(told_often, time * MILLISECOND);
    EXPECT_EQ(told_often.outputs().brake_engaged, time == 31) << time;
  }
  // A command that is taken back before its delay is over changes nothing.
  twin.commandBrake(40 * MILLISECOND, false);
  twin.commandBrake(50 * MILLISECOND, true);
  for (Stamp time = 40; time < 100; ++time)
  {
    advance(twin, time * MILLISECOND);
    ASSERT_TRUE(twin.outputs().brake_engaged) << time;
  }
}

TEST(TwinDrive, FollowsItsCommandAsTheCurrentLoopLetsIt)
{
  constexpr double BANDWIDTH = 200.0;  // [Hz]
  Twin twin(shippedParameters({ "motor.current_bandwidth=200.0", "input.command_timeout=10.0" }));
  twin.commandMotorTorque(0, 1.0);
  for (int step = 0; step <= 100; ++step)
  {
    advance(twin, step * MILLISECOND / 10);
    const double expected = -std::expm1(-TWO_PI * BANDWIDTH * step * 1e-4);
    ASSERT_NEAR(twin.outputs().motor_torque, expected, 1e-9) << step;
  }
}

TEST(TwinDrive, GivesLessTorqueWithWarmMagnets)
{
  Twin twin(shippedParameters(
      { "motor.torque_temperature_coefficient=-1.1e-3", "input.temperature=65.0", "input.command_timeout=10.0" }));
  twin.commandMotorTorque(0, 1.0);
  advance(twin, 10 * MILLISECOND);
  EXPECT_NEAR(twin.outputs().motor_torque, 1.0 - 40.0 * 1.1e-3, 1e-12);
}

constexpr Stamp END = std::numeric_limits<Stamp>::max();

Input torque(Stamp stamp, double value)
{
  return { stamp, InputKind::MOTOR_TORQUE, value };
}

std::vector<double> popAll(InputQueue& queue)
{
  std::vector<double> values;
  Input input;
  while (queue.pop(END, input))
  {
    values.push_back(input.value);
  }
  return values;
}

TEST(InputQueue, KeepsArrivalOrderOfEqualStampsOverManyTurnsOfItsStore)
{
  SeededRandom random(std::random_device{}());
  std::uniform_int_distribution<Stamp> stamps(0, 50);
  const auto queue = std::make_unique<InputQueue>();
  for (int round = 0; round < 100; ++round)
  {
    std::vector<Input> sent(300);
    for (std::size_t i = 0; i < sent.size(); ++i)
    {
      sent[i] = torque(stamps(random), static_cast<double>(i));
      queue->push(sent[i], 0);
    }
    std::stable_sort(sent.begin(), sent.end(), [](const Input& a, const Input& b) { return a.stamp < b.stamp; });
    Input input;
    for (const Input& expected : sent)
    {
      ASSERT_TRUE(queue->pop(END, input));
      ASSERT_EQ(input.stamp, expected.stamp);
      ASSERT_EQ(input.value, expected.value);
    }
    ASSERT_FALSE(queue->pop(END, input));
  }
  EXPECT_EQ(queue->counters().accepted, 30000u);
  EXPECT_EQ(queue->counters().overflow, 0u);
}

TEST(InputQueue, DropsTheOldestWhenFull)
{
  const auto queue = std::make_unique<InputQueue>();
  const auto capacity = static_cast<Stamp>(InputQueue::CAPACITY);
  for (Stamp stamp = 0; stamp < capacity + 3; ++stamp)
  {
    queue->push(torque(stamp, static_cast<double>(stamp)), 0);
  }
  queue->push(torque(0, -1.0), 0);  // older than all that is held: itself the oldest
  EXPECT_EQ(queue->counters().overflow, 4u);
  EXPECT_EQ(queue->counters().accepted, InputQueue::CAPACITY + 3);
  const std::vector<double> values = popAll(*queue);
  ASSERT_EQ(values.size(), InputQueue::CAPACITY);
  EXPECT_EQ(values.front(), 3.0);
  EXPECT_EQ(values.back(), static_cast<double>(capacity + 2));
}

TEST(InputQueue, ForgetsInputsAndCountersWhenCleared)
{
  const auto queue = std::make_unique<InputQueue>();
  queue->push(torque(1, 1.0), 5);
  queue->push(torque(1, std::numeric_limits<double>::quiet_NaN()), 5);
  queue->clear();
  EXPECT_TRUE(queue->empty());
  EXPECT_TRUE(popAll(*queue).empty());
  EXPECT_EQ(queue->counters().accepted + queue->counters().not_finite + queue->counters().late, 0u);
}

TEST(InputQueue, DoesNotAllocate)
{
  const auto queue = std::make_unique<InputQueue>();
  const std::size_t before = allocationCount();
  Input input;
  for (Stamp stamp = 0; stamp < 3 * static_cast<Stamp>(InputQueue::CAPACITY); ++stamp)
  {
    queue->push(torque(stamp % 5000, 1.0), 100);
    if (stamp % 3 == 0)
    {
      queue->pop(stamp, input);
    }
  }
  EXPECT_EQ(allocationCount(), before);
}
}  // namespace
}  // namespace hjt
