// SPDX-License-Identifier: BSD-3-Clause
#include "health/health_monitor.hpp"

#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "model/lobe_loads.hpp"
#include "test/core/health_monitor_support.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
constexpr double MARK = TWO_PI / (16 * 200);  // spacing of the turn window's marks [rad]

double perfect(double motor_angle)
{
  return motor_angle / RATIO;
}

using TransmissionRatio = Monitored;

TEST_F(TransmissionRatio, ComesWithTheFirstWholeTurn)
{
  update();
  turnTo(TWO_PI - 0.01, 0.003, perfect);
  EXPECT_FALSE(indicators().transmission_ratio.valid);
  EXPECT_EQ(indicators().transmission_ratio.value, 0.0);
  turnTo(TWO_PI + 3 * MARK, 0.003, perfect);
  ASSERT_TRUE(indicators().transmission_ratio.valid);
  EXPECT_NEAR(indicators().transmission_ratio.value, RATIO, 1e-9);
}

TEST_F(TransmissionRatio, IsThatOfTheMotionNotTheNominalOne)
{
  update();
  turnTo(-30.0, 0.03, [](double motor_angle) { return motor_angle / 97.5; });
  ASSERT_TRUE(indicators().transmission_ratio.valid);
  EXPECT_NEAR(indicators().transmission_ratio.value, 97.5, 1e-9);
}

TEST_F(TransmissionRatio, ReachesBackExactlyOneTurn)
{
  // An output that lags ever more: the ratio depends on which instants are compared.
  const auto output = [](double angle) { return angle / RATIO - 1e-6 * angle * angle; };
  update();
  for (const double angle : { 9.0, 11.3, 17.77, 31.415 })
  {
    turnTo(angle, 0.03, output);
    const double expected = TWO_PI / (output(angle) - output(angle - TWO_PI));
    // Linear interpolation of the samples: 1e-6 * 0.03^2 / 4 of 0.062 rad.
    EXPECT_NEAR(indicators().transmission_ratio.value, expected, 1e-6) << "at " << angle;
  }
}

TEST_F(TransmissionRatio, IsLostByAnAngleThatCountsNoMarks)
{
  for (const double angle : { 1e300, -1e18, std::numeric_limits<double>::quiet_NaN() })
  {
    for (int i = 0; i < 3; ++i)
    {
      sample_.motor_angle = i % 2 == 0 ? angle : -angle;
      update();
      EXPECT_FALSE(indicators().transmission_ratio.valid) << angle;
    }
    sample_.motor_angle = 0.0;
    update();
    turnTo(TWO_PI + 3 * MARK, 0.003, perfect);
    ASSERT_TRUE(indicators().transmission_ratio.valid) << angle;
    EXPECT_NEAR(indicators().transmission_ratio.value, RATIO, 1e-9);
  }
}

TEST_F(TransmissionRatio, IsLostByAReversalUntilATurnIsDone)
{
  update();
  turnTo(20.0, 0.003, perfect);
  ASSERT_TRUE(indicators().transmission_ratio.valid);
  turnTo(20.0 - 2.1 * MARK, 0.1 * MARK, perfect);
  EXPECT_FALSE(indicators().transmission_ratio.valid);
  EXPECT_FALSE(indicators().kinematic_error.valid);
  turnTo(20.0 - TWO_PI, 0.003, perfect);
  EXPECT_FALSE(indicators().transmission_ratio.valid);
  turnTo(20.0 - TWO_PI - 5 * MARK, 0.003, perfect);
  ASSERT_TRUE(indicators().transmission_ratio.valid);
  EXPECT_NEAR(indicators().transmission_ratio.value, RATIO, 1e-9);
  EXPECT_TRUE(indicators().kinematic_error.valid);
}

TEST_F(TransmissionRatio, SurvivesATremor)
{
  constexpr double PLACE = 10000.5 * MARK;
  update();
  turnTo(PLACE, 0.003, perfect);
  for (int i = 0; i < 100; ++i)
  {
    turnTo(PLACE - 1.4 * MARK, 0.3 * MARK, perfect);
    ASSERT_TRUE(indicators().transmission_ratio.valid);
    turnTo(PLACE, 0.3 * MARK, perfect);
    ASSERT_TRUE(indicators().transmission_ratio.valid);
    ASSERT_NEAR(indicators().transmission_ratio.value, RATIO, 1e-9);
  }
}

TEST_F(TransmissionRatio, IsNotGivenForAnOutputThatStandsStill)
{
  update();
  turnTo(10.0, 0.003, [](double) { return 0.0; });
  EXPECT_FALSE(indicators().transmission_ratio.valid);
  EXPECT_EQ(indicators().transmission_ratio.value, 0.0);
  EXPECT_TRUE(indicators().kinematic_error.valid);
}

using KinematicError = Monitored;

TEST_F(KinematicError, IsPeakToPeakOfWhatRepeatsEveryTurn)
{
  constexpr double AMPLITUDE = 3e-5;
  for (const int order : { 1, 2, 4 })
  {
    monitor_.reset();
    sample_ = {};
    turnTo(15.0, 0.005, [order](double angle) { return angle / RATIO + AMPLITUDE * std::sin(order * angle + 0.7); });
    ASSERT_TRUE(indicators().kinematic_error.valid);
    // Marks miss a crest by half a spacing at most, samples likewise.
    EXPECT_NEAR(indicators().kinematic_error.value, 2 * AMPLITUDE, 2 * AMPLITUDE * 2e-4) << "order " << order;
  }
}

TEST_F(KinematicError, ResolvesTheToothPitch)
{
  constexpr double AMPLITUDE = 5e-7;
  turnTo(10.0, 0.0005, [](double angle) { return angle / RATIO + AMPLITUDE * std::sin(200 * angle + 0.3); });
  // Sixteen marks a period: a crest is missed by 1 - cos(pi / 16) = 1.9 % at most.
  EXPECT_NEAR(indicators().kinematic_error.value, 2 * AMPLITUDE, 2 * AMPLITUDE * 0.02);
}

TEST_F(KinematicError, LeavesOutAMotionOfConstantRatio)
{
  turnTo(15.0, 0.005, [](double angle) { return angle / 100.0 + 2e-5 * std::cos(2 * angle); });
  EXPECT_NEAR(indicators().kinematic_error.value, 4e-5, 4e-5 * 2e-4);
}

TEST_F(KinematicError, ForgetsWhatIsOlderThanATurn)
{
  turnTo(10.0, 0.005, [](double angle) { return angle / RATIO + 1e-4 * std::sin(2 * angle); });
  turnTo(10.0 + TWO_PI + 2 * MARK, 0.005,
         [](double angle) { return angle / RATIO + 1e-4 * std::sin(20.0) + 1e-5 * std::sin(2 * (angle - 10.0)); });
  EXPECT_NEAR(indicators().kinematic_error.value, 2e-5, 2e-5 * 1e-3);
}

TEST_F(KinematicError, ForgetsAfterExactlyOneTurnWhereverTheStoreBegins)
{
  constexpr int TURN = 16 * 200;
  for (int spike = TURN - 5; spike < TURN + 5; ++spike)
  {
    monitor_.reset();
    sample_ = {};
    // Samples between the marks: a spike of one sample raises the marks before and behind it.
    const auto step_to = [&](int mark)
    {
      sample_.motor_angle = (mark + 0.5) * MARK;
      sample_.output_angle = perfect(sample_.motor_angle) + (mark == spike ? 1e-5 : 0.0);
      update();
    };
    for (int mark = 0; mark <= spike + 1 + TURN; ++mark)
    {
      step_to(mark);
    }
    EXPECT_GT(indicators().kinematic_error.value, 1e-6) << "spike at mark " << spike;
    step_to(spike + 2 + TURN);
    EXPECT_NEAR(indicators().kinematic_error.value, 0.0, 1e-12) << "spike at mark " << spike;
  }
}

TEST_F(KinematicError, KeepsTheLastTurnThroughALeapOfManyTurns)
{
  update();
  turnTo(1000.0, 500.0, perfect);
  ASSERT_TRUE(indicators().kinematic_error.valid);
  EXPECT_NEAR(indicators().kinematic_error.value, 0.0, 1e-12);
  EXPECT_NEAR(indicators().transmission_ratio.value, RATIO, 1e-6);
}

using TorsionalStiffness = Monitored;

/// Joint torque of a swing, and the output angle it twists the drive to with the motor held.
void swing(double time, double stiffness, double amplitude, HealthSample& sample)
{
  sample.joint_torque = 30.0 + amplitude * std::sin(10.0 * time);
  sample.output_angle = 2.0 - sample.joint_torque / stiffness;
}

TEST_F(TorsionalStiffness, IsTheSlopeOfTorqueOverTorsion)
{
  run(2.0, [](double time, HealthSample& sample) { swing(time, 31e3, 20.0, sample); });
  ASSERT_TRUE(indicators().torsional_stiffness.valid);
  EXPECT_NEAR(indicators().torsional_stiffness.value, 31e3, 31e3 * 1e-9);
  EXPECT_NEAR(indicators().torsion, -sample_.output_angle, 1e-15);
}

TEST_F(TorsionalStiffness, NeedsTheTorqueToVary)
{
  run(2.0, [](double time, HealthSample& sample) { swing(time, 31e3, 4.9, sample); });
  EXPECT_FALSE(indicators().torsional_stiffness.valid);
  EXPECT_EQ(indicators().torsional_stiffness.value, 0.0);
  run(0.5, [](double time, HealthSample& sample) { swing(time, 31e3, 5.1, sample); });
  EXPECT_TRUE(indicators().torsional_stiffness.valid);
  run(0.99, [](double, HealthSample&) {});  // at most two windows of 0.5 s
  EXPECT_FALSE(indicators().torsional_stiffness.valid);
}

TEST_F(TorsionalStiffness, FollowsAChangeOfTheDrive)
{
  run(2.0, [](double time, HealthSample& sample) { swing(time, 40e3, 20.0, sample); });
  run(10.0, [](double time, HealthSample& sample) { swing(time, 20e3, 20.0, sample); });
  // Twenty windows on, e^-20 of the old is left, its torsion some times larger than the new swing's.
  EXPECT_NEAR(indicators().torsional_stiffness.value, 20e3, 20e3 * 1e-6);
}

TEST_F(TorsionalStiffness, AveragesHysteresisOut)
{
  // A loop: torque leads the torsion, no slope of its own.
  run(5.0,
      [](double time, HealthSample& sample)
      {
        sample.joint_torque = 31.0 * std::sin(20.0 * PI * time) + 3.0 * std::cos(20.0 * PI * time);
        sample.output_angle = -1e-3 * std::sin(20.0 * PI * time);
      });
  EXPECT_NEAR(indicators().torsional_stiffness.value, 31e3, 31e3 * 0.01);
}

TEST(AllocationCount, SeesNewAndMalloc)
{
  std::size_t before = allocationCount();
  const auto number = std::make_unique<int>(1);
  EXPECT_EQ(allocationCount(), before + 1);
  before = allocationCount();
  const Eigen::VectorXd vector = Eigen::VectorXd::Zero(100);
  EXPECT_EQ(allocationCount(), before + 1) << vector.size() + *number;
}

TEST(HealthMonitor, DoesNotAllocateAfterConstruction)
{
  HealthMonitor monitor(health(), gear());
  const Eigen::VectorXd forces = Eigen::VectorXd::Ones(200);
  const std::size_t before = allocationCount();
  HealthSample sample;
  double sum = 0.0;
  for (int i = 0; i < 10000; ++i)
  {
    sample.stamp += STEP;
    sample.motor_angle = 30.0 * std::sin(1e-3 * i);
    sample.output_angle = sample.motor_angle / RATIO;
    monitor.update(sample);
    sum += monitor.indicators().transmission_ratio.value;
  }
  sum += lobeLoads({ forces, forces, forces, 0.0 }).wave_generator_force;
  monitor.reset();
  EXPECT_EQ(allocationCount(), before);
  EXPECT_GT(sum, 0.0);
}
}  // namespace
}  // namespace hjt
