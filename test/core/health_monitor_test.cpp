// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "health/health_monitor.hpp"
#include "model/lobe_loads.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
constexpr std::int64_t STEP = 100000;  // [ns]
constexpr double RATIO = 101.0;

GearParameters gear()
{
  GearParameters gear;
  gear.teeth_flexspline = 200;
  gear.teeth_circular_spline = 202;
  return gear;
}

HealthParameters health()
{
  HealthParameters health;
  health.stiffness_torque_span = 10.0;
  health.averaging_time = 0.5;
  return health;
}

class Monitored : public testing::Test
{
protected:
  /// Turns the motor to `end` in steps of `step`, the output given as a function of the motor angle.
  void turnTo(double end, double step, const std::function<double(double)>& output)
  {
    const auto steps = static_cast<int>(std::ceil(std::abs(end - sample_.motor_angle) / step - 1e-9));
    const double start = sample_.motor_angle;
    for (int i = 1; i <= steps; ++i)
    {
      sample_.motor_angle = start + (end - start) * i / steps;
      sample_.output_angle = output(sample_.motor_angle);
      update();
    }
  }

  /// Lets the sample stand for a time [s], after `change` at every step with the time since the call [s].
  void run(double duration, const std::function<void(double, HealthSample&)>& change)
  {
    for (std::int64_t elapsed = 0; elapsed < std::llround(1e9 * duration); elapsed += STEP)
    {
      change(1e-9 * static_cast<double>(elapsed), sample_);
      update();
    }
  }

  void update()
  {
    monitor_.update(sample_);
    sample_.stamp += STEP;
  }

  MotionIndicators indicators() const { return monitor_.indicators(); }
  Indicator ratio() const { return indicators().transmission_ratio; }

  void expectRatio(double value, double tolerance = 1e-9) const
  {
    ASSERT_TRUE(ratio().valid) << sample_.motor_angle;
    EXPECT_NEAR(ratio().value, value, tolerance) << sample_.motor_angle;
  }

  void restart()
  {
    monitor_.reset();
    sample_ = {};
  }

  HealthMonitor monitor_{ health(), gear() };
  HealthSample sample_;
};

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
  EXPECT_FALSE(ratio().valid);
  EXPECT_EQ(ratio().value, 0.0);
  turnTo(TWO_PI + 3 * MARK, 0.003, perfect);
  expectRatio(RATIO);
}

TEST_F(TransmissionRatio, IsThatOfTheMotionNotTheNominalOne)
{
  update();
  turnTo(-30.0, 0.03, [](double motor_angle) { return motor_angle / 97.5; });
  expectRatio(97.5);
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
    expectRatio(expected, 1e-6);
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
      EXPECT_FALSE(ratio().valid) << angle;
    }
    sample_.motor_angle = 0.0;
    update();
    turnTo(TWO_PI + 3 * MARK, 0.003, perfect);
    expectRatio(RATIO);
  }
}

TEST_F(TransmissionRatio, IsLostByAReversalUntilATurnIsDone)
{
  update();
  turnTo(20.0, 0.003, perfect);
  ASSERT_TRUE(ratio().valid);
  turnTo(20.0 - 2.1 * MARK, 0.1 * MARK, perfect);
  EXPECT_FALSE(ratio().valid);
  EXPECT_FALSE(indicators().kinematic_error.valid);
  turnTo(20.0 - TWO_PI, 0.003, perfect);
  EXPECT_FALSE(ratio().valid);
  turnTo(20.0 - TWO_PI - 5 * MARK, 0.003, perfect);
  expectRatio(RATIO);
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
    ASSERT_TRUE(ratio().valid);
    turnTo(PLACE, 0.3 * MARK, perfect);
    expectRatio(RATIO);
  }
}

TEST_F(TransmissionRatio, IsNotGivenForAnOutputThatStandsStill)
{
  update();
  turnTo(10.0, 0.003, [](double) { return 0.0; });
  EXPECT_FALSE(ratio().valid);
  EXPECT_EQ(ratio().value, 0.0);
  EXPECT_TRUE(indicators().kinematic_error.valid);
}

using KinematicError = Monitored;

/// Of any constant ratio. Marks miss a crest by half a spacing at most, samples likewise; of sixteen marks a period, as
/// of the tooth pitch, by 1 - cos(pi / 16) = 1.9 %.
TEST_F(KinematicError, IsPeakToPeakOfWhatRepeatsEveryTurn)
{
  struct Row
  {
    int order;
    double amplitude;
    double ratio;
    double step;  // [rad]
    double miss;
  };
  for (const Row& row :
       { Row{ 1, 3e-5, RATIO, 0.005, 2e-4 }, Row{ 2, 3e-5, RATIO, 0.005, 2e-4 }, Row{ 4, 3e-5, RATIO, 0.005, 2e-4 },
         Row{ 2, 2e-5, 100.0, 0.005, 2e-4 }, Row{ 200, 5e-7, RATIO, 0.0005, 0.02 } })
  {
    restart();
    turnTo(15.0, row.step,
           [&](double angle) { return angle / row.ratio + row.amplitude * std::sin(row.order * angle + 0.7); });
    ASSERT_TRUE(indicators().kinematic_error.valid);
    EXPECT_NEAR(indicators().kinematic_error.value, 2 * row.amplitude, 2 * row.amplitude * row.miss) << row.order;
  }
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
    restart();
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
  EXPECT_NEAR(ratio().value, RATIO, 1e-6);
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

using Efficiency = Monitored;

void flow(double motor_power, double joint_power, HealthSample& sample)
{
  sample.motor_velocity = 100.0;
  sample.output_velocity = 100.0 / RATIO;
  sample.motor_torque = motor_power / sample.motor_velocity;
  sample.joint_torque = joint_power / sample.output_velocity;
}

TEST_F(Efficiency, ComesWithTheFirstWindowAndGoesAtStandstill)
{
  const auto driving = [](double, HealthSample& sample) { flow(50.0, 35.0, sample); };
  run(0.45, driving);
  EXPECT_FALSE(indicators().efficiency.valid) << "before one window";
  run(0.1, driving);
  ASSERT_TRUE(indicators().efficiency.valid);
  EXPECT_NEAR(indicators().efficiency.value, 0.7, 1e-12);
  run(5.0, [](double, HealthSample& sample) { flow(0.0, 0.0, sample); });
  EXPECT_FALSE(indicators().efficiency.valid);
}

/// What is left of a pulse in an exponential mean: 0.9 / (200 pi 0.5) on both sides.
TEST_F(Efficiency, IsTheRatioOfMeansOfTheSideThatDrives)
{
  struct Row
  {
    double motor_power;  // mean [W]
    double joint_power;  // [W]
    double pulse;        // of the motor's power, over its mean
    double joint_pulse;  // of the joint's
    double expected;     // none: 0
    double tolerance;
    const char* text;
  };
  for (const Row& row : { Row{ -20.0, -50.0, 0.0, 0.0, 0.4, 1e-12, "driven back" },
                          Row{ 50.0, 30.0, 0.9, -0.9, 0.6, 0.6 * 0.006, "a pulsating flow" },
                          Row{ 20.0, -5.0, 0.0, 0.0, 0.0, 0.0, "both sides put power in" },
                          Row{ 25.0, 15.0, 2.0, 2.0, 0.0, 0.0, "the flow turns back and forth" },
                          Row{ 10.0, 12.0, 0.0, 0.0, 0.0, 0.0, "inertia pays" } })
  {
    restart();
    run(3.0,
        [&](double time, HealthSample& sample)
        {
          const double wave = std::sin(200.0 * PI * time);
          flow(row.motor_power * (1.0 + row.pulse * wave), row.joint_power * (1.0 + row.joint_pulse * wave), sample);
        });
    EXPECT_EQ(indicators().efficiency.valid, row.expected > 0.0) << row.text;
    EXPECT_NEAR(indicators().efficiency.value, row.expected, row.tolerance) << row.text;
  }
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

TEST(LobeLoads, SharesTeethByTheirLobe)
{
  const int teeth = 8;
  Eigen::VectorXd angle(teeth);
  for (int i = 0; i < teeth; ++i)
  {
    angle[i] = TWO_PI * i / teeth + 0.01;
  }
  Eigen::VectorXd mesh(teeth);
  mesh << 10.0, -20.0, 0.0, 0.0, 5.0, 0.0, -1.0, 0.0;
  const Eigen::VectorXd wave_generator = Eigen::VectorXd::Constant(teeth, 4.0);
  const LobeLoads loads = lobeLoads({ mesh, wave_generator, angle, 0.0 });
  EXPECT_EQ(loads.teeth_loaded, 4);
  EXPECT_DOUBLE_EQ(loads.mesh_force[0], 31.0);
  EXPECT_DOUBLE_EQ(loads.mesh_force[1], 5.0);
  EXPECT_DOUBLE_EQ(loads.asymmetry, 26.0 / 36.0);
  EXPECT_DOUBLE_EQ(loads.wave_generator_force, 32.0);

  // Half a turn on, the lobes have changed places; after many turns they are where they were.
  EXPECT_DOUBLE_EQ(lobeLoads({ mesh, wave_generator, angle, PI }).mesh_force[0], 5.0);
  EXPECT_DOUBLE_EQ(lobeLoads({ mesh, wave_generator, angle, -50 * TWO_PI }).mesh_force[0], 31.0);
}

TEST(LobeLoads, AreEvenWithoutLoad)
{
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(10);
  const LobeLoads loads = lobeLoads({ none, none, none, 1.0 });
  EXPECT_EQ(loads.teeth_loaded, 0);
  EXPECT_EQ(loads.asymmetry, 0.0);
}
}  // namespace
}  // namespace hjt
