// SPDX-License-Identifier: BSD-3-Clause
#include "health/health_monitor.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "model/lobe_loads.hpp"
#include "test/core/health_monitor_support.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
using Efficiency = Monitored;

void flow(double motor_power, double joint_power, HealthSample& sample)
{
  sample.motor_velocity = 100.0;
  sample.output_velocity = 100.0 / RATIO;
  sample.motor_torque = motor_power / sample.motor_velocity;
  sample.joint_torque = joint_power / sample.output_velocity;
}

TEST_F(Efficiency, IsJointPowerOverMotorPowerWhenDriving)
{
  run(0.45, [](double, HealthSample& sample) { flow(50.0, 35.0, sample); });
  EXPECT_FALSE(indicators().efficiency.valid) << "before one window";
  run(0.1, [](double, HealthSample& sample) { flow(50.0, 35.0, sample); });
  ASSERT_TRUE(indicators().efficiency.valid);
  EXPECT_NEAR(indicators().efficiency.value, 0.7, 1e-12);
}

TEST_F(Efficiency, IsMotorPowerOverJointPowerWhenDrivenBack)
{
  run(1.0, [](double, HealthSample& sample) { flow(-20.0, -50.0, sample); });
  ASSERT_TRUE(indicators().efficiency.valid);
  EXPECT_NEAR(indicators().efficiency.value, 0.4, 1e-12);
}

TEST_F(Efficiency, IsTheRatioOfMeansOfAPulsatingFlow)
{
  run(3.0,
      [](double time, HealthSample& sample)
      {
        const double pulse = 1.0 + 0.9 * std::sin(200.0 * PI * time);
        flow(50.0 * pulse, 30.0 * (2.0 - pulse), sample);
      });
  ASSERT_TRUE(indicators().efficiency.valid);
  // What is left of the pulse in an exponential mean: 0.9 / (200 pi 0.5) on both sides.
  EXPECT_NEAR(indicators().efficiency.value, 0.6, 0.6 * 0.006);
}

TEST_F(Efficiency, IsNotGivenWhenBothSidesPutPowerIn)
{
  run(1.0, [](double, HealthSample& sample) { flow(20.0, -5.0, sample); });
  EXPECT_FALSE(indicators().efficiency.valid);
  EXPECT_EQ(indicators().efficiency.value, 0.0);
}

TEST_F(Efficiency, IsNotGivenAtStandstill)
{
  run(1.0, [](double, HealthSample& sample) { flow(50.0, 35.0, sample); });
  ASSERT_TRUE(indicators().efficiency.valid);
  run(5.0, [](double, HealthSample& sample) { flow(0.0, 0.0, sample); });
  EXPECT_FALSE(indicators().efficiency.valid);
}

TEST_F(Efficiency, IsNotGivenWhileTheFlowTurnsBackAndForth)
{
  run(3.0,
      [](double time, HealthSample& sample)
      {
        const double pulse = 0.5 + std::sin(200.0 * PI * time);
        flow(50.0 * pulse, 30.0 * pulse, sample);
      });
  EXPECT_FALSE(indicators().efficiency.valid);
}

TEST_F(Efficiency, IsNotGivenWhenInertiaPays)
{
  run(1.0, [](double, HealthSample& sample) { flow(10.0, 12.0, sample); });
  EXPECT_FALSE(indicators().efficiency.valid);
}

TEST_F(Efficiency, StartsAnewAfterReset)
{
  run(1.0, [](double, HealthSample& sample) { flow(50.0, 35.0, sample); });
  monitor_.reset();
  EXPECT_FALSE(indicators().efficiency.valid);
  sample_.stamp = 0;  // the clock has jumped back
  run(1.0, [](double, HealthSample& sample) { flow(50.0, 25.0, sample); });
  EXPECT_NEAR(indicators().efficiency.value, 0.5, 1e-12);
}
}  // namespace
}  // namespace hjt
