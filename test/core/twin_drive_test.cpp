// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/twin.hpp"

#include <cmath>

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
}  // namespace
}  // namespace hjt
