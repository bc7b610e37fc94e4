// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "harmonic_joint_twin/gear/angle.hpp"
#include "harmonic_joint_twin/sensors/absolute_encoder.hpp"
#include "harmonic_joint_twin/sensors/incremental_encoder.hpp"
#include "harmonic_joint_twin/sensors/velocity_estimate.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
constexpr int COUNTS = 4320;
constexpr double QUANTUM = TWO_PI / COUNTS;
const SensorParameters SENSORS{ COUNTS, 19, 10e-3 };

TEST(IncrementalEncoder, CountsDownBelowZeroWithoutAGap)
{
  const IncrementalEncoder encoder(SENSORS);
  EXPECT_EQ(encoder.count(0.0), 0);
  for (std::int64_t count = -2 * COUNTS; count < 2 * COUNTS; ++count)
  {
    ASSERT_EQ(encoder.count((static_cast<double>(count) + 0.5) * QUANTUM), count);
  }
  EXPECT_EQ(encoder.count(1e6 * TWO_PI + 0.5 * QUANTUM), 1000000ll * COUNTS);
}

TEST(IncrementalEncoder, AngleIsWithinOneCountBelowTheTrueOne)
{
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> angles(-1000.0, 1000.0);
  const IncrementalEncoder encoder(SENSORS);
  constexpr double ROUNDING = 1e-12;  // of an angle of 1000 rad
  for (int i = 0; i < 10000; ++i)
  {
    const double angle = angles(random);
    const double behind = angle - encoder.angle(encoder.count(angle));
    ASSERT_GE(behind, -ROUNDING) << angle;
    ASSERT_LE(behind, QUANTUM + ROUNDING) << angle;
  }
}

TEST(AbsoluteEncoder, WrapsEveryTurnInBothDirections)
{
  SensorParameters parameters = SENSORS;
  parameters.output_bits = 4;
  const AbsoluteEncoder encoder(parameters);
  for (int turn = -3; turn <= 3; ++turn)
  {
    for (int count = 0; count < 16; ++count)
    {
      const double angle = TWO_PI * (turn + (count + 0.5) / 16.0);
      ASSERT_EQ(encoder.count(angle), static_cast<std::uint32_t>(count)) << "turn " << turn;
      ASSERT_NEAR(encoder.unwrappedAngle(angle), angle - TWO_PI * 0.5 / 16.0, 1e-12) << "turn " << turn;
    }
  }
}

TEST(AbsoluteEncoder, UnwrappedAngleIsRightHoweverSeldomRead)
{
  const AbsoluteEncoder encoder(SENSORS);
  const double quantum = TWO_PI / (1 << 19);
  for (double angle = -100.0; angle < 100.0; angle += 7.3)  // more than a turn between two readings
  {
    const double behind = angle - encoder.unwrappedAngle(angle);
    ASSERT_GE(behind, -1e-12);
    ASSERT_LE(behind, quantum + 1e-12);
    const double turns = (encoder.unwrappedAngle(angle) - encoder.count(angle) * quantum) / TWO_PI;
    ASSERT_NEAR(turns, std::round(turns), 1e-9);
  }
}

TEST(AbsoluteEncoder, ServesTheLargestNumberOfBits)
{
  SensorParameters parameters = SENSORS;
  parameters.output_bits = 30;
  const AbsoluteEncoder encoder(parameters);
  EXPECT_EQ(encoder.count(-1e-9), (1u << 30) - 1u);
}

TEST(VelocityEstimate, IsTheDifferenceOverTheWindow)
{
  VelocityEstimate estimate(10e-3, 1e-3);
  std::vector<double> angles;
  for (int i = 0; i < 40; ++i)
  {
    const double angle = 0.01 * i * i;
    angles.push_back(angle);
    estimate.update(angle);
    const int oldest = std::max(0, i - 10);
    const double expected = i == 0 ? 0.0 : (angle - angles[oldest]) / ((i - oldest) * 1e-3);
    ASSERT_NEAR(estimate.velocity(), expected, 1e-9) << "sample " << i;
  }
}

TEST(VelocityEstimate, StartsAnewAfterReset)
{
  VelocityEstimate estimate(10e-3, 1e-3);
  EXPECT_EQ(estimate.velocity(), 0.0);
  estimate.update(1.0);
  estimate.update(2.0);
  estimate.reset();
  EXPECT_EQ(estimate.velocity(), 0.0);
  estimate.update(500.0);
  EXPECT_EQ(estimate.velocity(), 0.0);
  estimate.update(500.5);
  EXPECT_NEAR(estimate.velocity(), 500.0, 1e-9);
}

TEST(VelocityEstimate, TakesAtLeastTheLastStep)
{
  VelocityEstimate estimate(1e-6, 1e-3);  // window shorter than a step
  estimate.update(0.0);
  estimate.update(1.0);
  estimate.update(3.0);
  EXPECT_NEAR(estimate.velocity(), 2000.0, 1e-9);
}

TEST(Encoders, DoNotAllocate)
{
  const IncrementalEncoder motor(SENSORS);
  const AbsoluteEncoder output(SENSORS);
  VelocityEstimate velocity(SENSORS.velocity_window, 1e-4);
  const std::size_t before = allocationCount();
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i)
  {
    const double angle = 0.03 * i;
    velocity.update(motor.angle(motor.count(angle)));
    sum += velocity.velocity() + output.unwrappedAngle(angle) + output.count(angle);
  }
  EXPECT_EQ(allocationCount(), before);
  EXPECT_GT(sum, 0.0);
}
}  // namespace
}  // namespace hjt
