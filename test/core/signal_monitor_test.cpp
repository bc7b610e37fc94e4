// SPDX-License-Identifier: BSD-3-Clause
#include "health/signal_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include <gmock/gmock.h>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/health/assessment.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "health/order_tracker.hpp"
#include "health/signature_file.hpp"
#include "sensors/joint_sensors.hpp"
#include "test/core/signal_monitor_support.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
TEST(SignalMonitor, FindsRatioAndPeakToPeak)
{
  Synthetic joint(shippedParameters());
  joint.error = [](double angle, double) { return 1e-5 * angle / RATIO + 20.0 * ARCSEC * std::cos(2.0 * angle); };
  const SignalIndicators& found = joint.nextWindow();
  EXPECT_NEAR(found[ScalarIndicator::RATIO_DEVIATION], 1e-5, 2e-6);
  // Two counts of both encoders lie on top.
  EXPECT_NEAR(found[ScalarIndicator::KINEMATIC_ERROR] / ARCSEC, 40.0, 8.0);
  EXPECT_GT(found[ScalarIndicator::KINEMATIC_ERROR] / ARCSEC, 40.0);
}

TEST(SignalMonitor, TellsCoulombFromViscousFrictionBesideGravity)
{
  Synthetic joint(shippedParameters());
  joint.speed = [](double time) { return 150.0 * std::sin(0.8 * time); };
  joint.torque = [](double angle, double speed)
  { return std::copysign(0.08, speed) + 4e-4 * speed + 0.2 * std::sin(angle / RATIO - 0.3); };
  const SignalIndicators& found = joint.nextWindow();
  EXPECT_NEAR(found[ScalarIndicator::COULOMB_TORQUE], 0.08, 0.002);
  EXPECT_NEAR(found[ScalarIndicator::VISCOUS_FRICTION], 4e-4, 2e-5);
}

TEST(SignalMonitor, DoesNotTellCoulombFromViscousFrictionAtOneSpeed)
{
  Synthetic joint(shippedParameters());
  const SignalIndicators& found = joint.nextWindow();
  EXPECT_TRUE(std::isnan(found[ScalarIndicator::COULOMB_TORQUE]));
  EXPECT_TRUE(std::isnan(found[ScalarIndicator::VISCOUS_FRICTION]));
}

/// Torsion with dry friction beside the spring: rising and falling branches `WIDTH` apart, from one to the other over
/// 2 N.m.
class WithLoop : public testing::Test
{
protected:
  static constexpr double STIFFNESS = 31e3;  // [N.m/rad]
  static constexpr double SECOND = 50e3;     // beyond T1
  static constexpr double WIDTH = 1.5e-4;    // [rad]
  static constexpr double SWING = 40.0;      // [N.m]

  void swing()
  {
    joint_.load = [](double time) { return SWING * std::sin(TWO_PI * 0.5 * time); };
    joint_.error = [this](double, double load)
    {
      centre_ = std::clamp(centre_, load - 1.0, load + 1.0);
      const double beyond = std::copysign(std::max(std::abs(load) - 14.0, 0.0), load);
      return load / STIFFNESS + beyond * (1.0 / SECOND - 1.0 / STIFFNESS) + 0.5 * (centre_ - load) * WIDTH;
    };
  }

  Synthetic joint_{ shippedParameters() };

private:
  double centre_{};  // [N.m]
};

TEST_F(WithLoop, StiffnessesLostMotionHysteresisAndAreaAreFound)
{
  swing();
  const SignalIndicators& found = joint_.nextWindow();
  EXPECT_NEAR(found[ScalarIndicator::TORSIONAL_STIFFNESS], STIFFNESS, 0.04 * STIFFNESS);
  EXPECT_NEAR(found[ScalarIndicator::SECOND_STIFFNESS], SECOND, 0.1 * SECOND);
  EXPECT_NEAR(found[ScalarIndicator::HYSTERESIS], WIDTH, 0.05 * WIDTH);
  // Between the middles of the loop at 2.7 N.m either way.
  EXPECT_NEAR(found[ScalarIndicator::LOST_MOTION], 2.0 * 2.7 / STIFFNESS, 0.05 * 2.0 * 2.7 / STIFFNESS);
  EXPECT_NEAR(found[ScalarIndicator::HYSTERESIS_AREA], WIDTH * 2.0 * SWING, 0.05 * WIDTH * 2.0 * SWING);
}

TEST(SignalMonitor, GivesNoStiffnessWithoutASwingingLoad)
{
  Synthetic joint(shippedParameters());
  joint.load = [](double) { return 5.0; };
  const SignalIndicators& found = joint.nextWindow();
  EXPECT_TRUE(std::isnan(found[ScalarIndicator::TORSIONAL_STIFFNESS]));
  EXPECT_TRUE(std::isnan(found[ScalarIndicator::LOST_MOTION]));
  EXPECT_TRUE(std::isnan(found[ScalarIndicator::HYSTERESIS_AREA]));
}

TEST(SignalMonitor, FindsEfficiencyWhereTheLoadIsKnown)
{
  Synthetic joint(shippedParameters());
  joint.load = [](double) { return 40.0; };
  joint.torque = [](double, double) { return 40.0 / RATIO / 0.75; };
  EXPECT_NEAR(joint.nextWindow()[ScalarIndicator::EFFICIENCY], 0.75, 1e-3);
}

TEST(SignalMonitor, ResidualOfNoiseIsGaussianAndOfImpulsesIsNot)
{
  const auto residual_of = [](double impulse)
  {
    Synthetic joint(shippedParameters());
    joint.quantised = false;
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0.0, 2e-6);
    std::uint64_t count = 0;
    joint.error = [&](double, double) { return noise(random) + (++count % 100 == 0 ? impulse : 0.0); };
    joint.nextWindow();
    return joint.nextWindow();
  };
  const SignalIndicators still = residual_of(0.0);
  EXPECT_NEAR(still[ScalarIndicator::RESIDUAL_RMS], 2e-6, 1e-7);
  EXPECT_NEAR(still[ScalarIndicator::RESIDUAL_KURTOSIS], 3.0, 0.2);
  EXPECT_LT(still[ScalarIndicator::RESIDUAL_CREST], 5.0);
  const SignalIndicators struck = residual_of(2e-5);
  EXPECT_GT(struck[ScalarIndicator::RESIDUAL_KURTOSIS], 10.0);
  EXPECT_GT(struck[ScalarIndicator::RESIDUAL_CREST], 5.0);
}

TEST(SignalMonitor, WorksWithTheOutputEncoderAlone)
{
  SignalMonitor monitor(shippedParameters());
  SignalSample sample;
  bool done = false;
  for (int i = 1; !done; ++i)
  {
    sample.stamp = i * SAMPLE;
    sample.output_angle = 100.0 / RATIO * 1e-9 * SAMPLE * i;
    sample.motor_torque = 0.1 + 0.01 * std::cos(4.0 * RATIO * sample.output_angle);
    done = monitor.update(sample);
  }
  EXPECT_NEAR(monitor.indicators().amplitude(LineSignal::MOTOR_TORQUE, Line::WAVE_GENERATOR_4), 0.01, 1e-5);
  EXPECT_TRUE(std::isnan(monitor.indicators().amplitude(LineSignal::KINEMATIC_ERROR, Line::WAVE_GENERATOR_4)));
  EXPECT_TRUE(std::isnan(monitor.indicators().amplitude(LineSignal::MOTOR_RIPPLE, Line::WAVE_GENERATOR_4)));
  EXPECT_TRUE(std::isnan(monitor.indicators()[ScalarIndicator::KINEMATIC_ERROR]));
}

/// A robot's joint at 125 Hz, one encoder, to and fro at up to 120 rad/s of the motor under a load: friction by load.
double loadFriction(double share)
{
  SignalMonitor monitor(shippedParameters({ "indicators.window_turns=1e5", "indicators.window_time=20.0" }));
  SignalSample sample;
  bool done = false;
  for (int i = 1; !done; ++i)
  {
    const double time = 8e-3 * i;
    sample.stamp = i * std::int64_t{ 8000000 };
    sample.output_angle = std::sin(1.2 * time);
    sample.load_torque = 60.0 * std::sin(sample.output_angle) + 8.0;
    const double speed = 1.2 * RATIO * std::cos(1.2 * time);
    sample.motor_torque = sample.load_torque / RATIO + 4e-4 * speed +
                          std::copysign(0.1 + share * std::abs(sample.load_torque) / RATIO, speed);
    done = monitor.update(sample);
  }
  return monitor.indicators()[ScalarIndicator::LOAD_FRICTION];
}

TEST(SignalMonitor, FindsFrictionThatGrowsWithTheLoad)
{
  EXPECT_NEAR(loadFriction(0.06), 0.06, 0.003);
  EXPECT_NEAR(loadFriction(0.0), 0.0, 0.003);
}

/// A joint at an even speed that is off its set points by a line at order 2, which changes its sign every `turns` of
/// the motor, as that of a cracked rim does with the load.
SignalIndicators windowWithLag(double line, double turns, bool has_set_points = true)
{
  constexpr double SPEED = 100.0;
  SignalMonitor monitor(shippedParameters({ "indicators.window_turns=240" }));
  SignalSample sample;
  bool done = false;
  for (int i = 1; !done; ++i)
  {
    sample.stamp = i * SAMPLE;
    const double angle = SPEED * 1e-9 * SAMPLE * i;
    const double sign = std::fmod(angle / TWO_PI / turns, 2.0) < 1.0 ? 1.0 : -1.0;
    sample.output_angle = (angle + sign * line * std::cos(2.0 * angle)) / RATIO;
    sample.target_angle = has_set_points ? angle / RATIO : std::nan("");
    sample.motor_torque = 0.1;
    done = monitor.update(sample);
  }
  return monitor.indicators();
}

TEST(SignalMonitor, FindsWhatAControllerLeavesOfItsSetPoints)
{
  constexpr double LINE = 1e-3;
  // RippleFilter of 20 ms at 200 rad/s, by steps of 0.5 ms.
  const double kept = std::exp(-1.0 / 40.0);
  const double share =
      std::pow(2.0 * std::sin(0.05) / std::abs(1.0 - std::polar(kept, 0.1)), 3) * kept * kept * (1.0 - kept) * 40.0;
  const SignalIndicators steady = windowWithLag(LINE, 1e6);
  EXPECT_NEAR(steady[ScalarIndicator::LAG_RIPPLE], share * LINE / std::sqrt(2.0), 0.005 * LINE);
  EXPECT_NEAR(steady[ScalarIndicator::LAG_ORDER_2], share * LINE, 0.005 * LINE);
  EXPECT_LT(steady[ScalarIndicator::LAG_ORDER_4], 0.06 * LINE);
  // The mean over two turns takes four turns of the power at each change of sign.
  EXPECT_NEAR(windowWithLag(LINE, 30.0)[ScalarIndicator::LAG_ORDER_2], share * LINE * std::sqrt(26.0 / 30.0),
              0.02 * LINE);
  EXPECT_LT(windowWithLag(0.0, 30.0)[ScalarIndicator::LAG_RIPPLE], 1e-9);
  EXPECT_TRUE(std::isnan(windowWithLag(LINE, 30.0, false)[ScalarIndicator::LAG_RIPPLE]));
}

/// A UR controller's 125 Hz: lines that its samples cannot show do not take those that they can.
TEST(SignalMonitor, FindsTheTeethOfTheCircularSplineInACurrentAt125Hz)
{
  SignalMonitor monitor(shippedParameters({ "indicators.window_turns=25.0" }));
  SignalSample sample;
  bool done = false;
  for (int i = 1; !done; ++i)
  {
    sample.stamp = i * std::int64_t{ 8000000 };
    sample.output_angle = 105.8 / RATIO * 8e-3 * i;
    sample.motor_torque = 0.1 + 0.014 * std::cos(2.0 * (RATIO - 1.0) * sample.output_angle);
    done = monitor.update(sample);
  }
  const SignalIndicators& found = monitor.indicators();
  EXPECT_NEAR(found.amplitude(LineSignal::MOTOR_TORQUE, Line::CIRCULAR_SPLINE_2), 0.014, 1e-4);
  EXPECT_NEAR(found.amplitude(LineSignal::MOTOR_TORQUE, Line::WAVE_GENERATOR_2), 0.0, 1e-4);
}

TEST(SignalMonitor, PassesOverSamplesThatSayNothing)
{
  SignalMonitor monitor(shippedParameters());
  SignalSample sample;
  EXPECT_FALSE(monitor.update(sample));
  sample.stamp = 1;
  sample.motor_angle = 0.0;
  sample.motor_torque = 0.0;
  monitor.update(sample);
  monitor.update(sample);  // no progress in time
  sample.stamp = std::numeric_limits<std::int64_t>::max();
  monitor.update(sample);  // of a damaged file
  EXPECT_EQ(monitor.refused(), 3U);
}

TEST(SignalMonitor, AllocatesNothingOverWindowsAndVerdicts)
{
  const Parameters parameters = shippedParameters({ "indicators.window_turns=20.0", "indicators.baseline_windows=8" });
  Synthetic joint(parameters);
  Assessor assessor(parameters);
  const std::uint64_t before = allocationCount();
  for (int window = 0; window < 11; ++window)
  {
    assessor.update(joint.nextWindow());
  }
  EXPECT_EQ(allocationCount(), before);
}
}  // namespace
}  // namespace hjt
