// SPDX-License-Identifier: BSD-3-Clause
#include "health/signal_monitor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/health/assessment.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "health/angle_multiples.hpp"
#include "health/signature_file.hpp"
#include "sensors/absolute_encoder.hpp"
#include "sensors/incremental_encoder.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
constexpr double ARCSEC = TWO_PI / 360.0 / 3600.0;
constexpr double RATIO = 101.0;

std::shared_ptr<const SignatureSet> shippedSignatures()
{
  return loadSignatures(shippedParameters().indicators.signatures);
}
constexpr std::int64_t SAMPLE = 500000;  // [ns]

/// A joint that moves as told, with a known error of motion and a known torque, read through the twin's encoders.
class Synthetic
{
public:
  explicit Synthetic(const Parameters& parameters)
    : orders(trackedOrders(parameters.gear, parameters.bearing))
    , monitor(parameters)
    , motor_encoder_(parameters.sensors)
    , output_encoder_(parameters.sensors)
  {
  }

  std::function<double(double)> speed = [](double) { return 100.0; };                 // of time [rad/s]
  std::function<double(double)> load = [](double) { return 0.0; };                    // of time [N.m]
  std::function<double(double, double)> error = [](double, double) { return 0.0; };   // motor angle, load [rad]
  std::function<double(double, double)> torque = [](double, double) { return 0.1; };  // motor angle, speed [N.m]
  // Of the motor: of its angle, the load and the time [rad]
  std::function<double(double, double, double)> ripple = [](double, double, double) { return 0.0; };
  bool quantised = true;

  /// One sample; true if it completed a window.
  bool step()
  {
    time_ += 1e-9 * SAMPLE;
    const double now = speed(time_);
    motor_angle_ += now * 1e-9 * SAMPLE;
    const double load_torque = load(time_);
    const double output_angle = motor_angle_ / RATIO - error(motor_angle_, load_torque);
    SignalSample sample;
    sample.stamp = stamp_ += SAMPLE;
    const double motor_angle = motor_angle_ + ripple(motor_angle_, load_torque, time_);
    sample.motor_angle = quantised ? motor_encoder_.angle(motor_encoder_.count(motor_angle)) : motor_angle;
    sample.output_angle = quantised ? output_encoder_.unwrappedAngle(output_angle) : output_angle;
    sample.motor_velocity = now;
    sample.motor_torque = torque(motor_angle_, now);
    sample.load_torque = load_torque;
    return monitor.update(sample);
  }

  const SignalIndicators& nextWindow()
  {
    while (!step())
    {
    }
    return monitor.indicators();
  }

  double line(Line which, double amplitude, double phase, double angle) const
  {
    return amplitude * std::cos(orders[index(which)] * angle + phase);
  }

  const LineOrders orders;
  SignalMonitor monitor;

private:
  IncrementalEncoder motor_encoder_;
  AbsoluteEncoder output_encoder_;
  double time_{};
  double motor_angle_{};
  std::int64_t stamp_{};
};

/// A joint that swings about its zero at `rate` [rad/s], a weight and an inertia on it.
OperatingPoint swing(double rate)
{
  constexpr double INERTIA = 3.5;
  constexpr double PEAK = 150.0;  // motor [rad/s]
  Synthetic joint(shippedParameters({ "indicators.window_turns=1e5", "indicators.window_time=20.0" }));
  double now = 0.0;
  joint.speed = [&](double time)
  {
    now = time;
    return PEAK * std::cos(rate * time);
  };
  joint.load = [&](double time)
  {
    const double angle = PEAK / rate * std::sin(rate * time) / RATIO;
    return 4.0 + 30.0 * std::sin(angle) - 20.0 * std::cos(angle);
  };
  joint.torque = [&](double /*angle*/, double /*speed*/)
  { return (joint.load(now) - INERTIA * PEAK * rate * std::sin(rate * now) / RATIO) / RATIO; };
  return joint.nextWindow().point;
}

TEST(OperatingPoint, HoldsWhatTheJointCarriesWhateverThePath)
{
  for (const double rate : { 1.2, 2.5 })
  {
    const OperatingPoint point = swing(rate);
    EXPECT_NEAR(point.load_constant, 4.0, 0.3) << rate;
    EXPECT_NEAR(point.load_sine, 30.0, 0.3) << rate;
    EXPECT_NEAR(point.load_cosine, -20.0, 0.3) << rate;
    EXPECT_NEAR(point.inertia, 3.5, 0.1) << rate;
  }
}

TEST(LoadOverAngle, IsConstantAtOneAngle)
{
  LoadOverAngle load;
  for (int i = 0; i < 100; ++i)
  {
    load.add(0.7, 12.0, 0.1);
  }
  EXPECT_NEAR(load.coefficients()[0], 12.0, 1e-9);
  EXPECT_NEAR(load.coefficients().tail<2>().norm(), 0.0, 1e-9);
  EXPECT_TRUE(std::isnan(LoadOverAngle().coefficients()[0]));
}

TEST(AngleMultiples, AreCosineAndSineOfEveryTrackedOrder)
{
  const Parameters parameters = shippedParameters();
  const LineOrders orders = trackedOrders(parameters.gear, parameters.bearing);
  const AngleMultiples<LINE_COUNT> multiples(orders);
  for (const double angle : { 0.0, 0.3, -2.7, 1e2, -3e4 })
  {
    std::array<double, 2 * LINE_COUNT> rotations{};
    multiples.at(angle, rotations.data());
    for (std::size_t line = 0; line < LINE_COUNT; ++line)
    {
      // Rounding of the order times the angle, and of two or three products.
      const double tolerance = 1e-15 * (10.0 + std::abs(orders[line] * angle));
      EXPECT_NEAR(rotations[2 * line], std::cos(orders[line] * angle), tolerance) << "order " << orders[line];
      EXPECT_NEAR(rotations[2 * line + 1], std::sin(orders[line] * angle), tolerance) << "order " << orders[line];
    }
  }
}

TEST(TrackedOrders, AreThoseOfTheGearAndItsBearing)
{
  const Parameters parameters = shippedParameters();
  const LineOrders orders = trackedOrders(parameters.gear, parameters.bearing);
  EXPECT_NEAR(orders[index(Line::CIRCULAR_SPLINE_2)], 1.9802, 5e-5);
  EXPECT_NEAR(orders[index(Line::CAGE_LOBES)], 1.10255, 5e-5);
  EXPECT_NEAR(orders[index(Line::BALL)], 9.6488, 5e-5);
  EXPECT_NEAR(orders[index(Line::BALL_FAR_BELOW)], 7.4437, 5e-5);
  EXPECT_NEAR(orders[index(Line::OUTER)], 10.3207, 5e-5);
  EXPECT_NEAR(orders[index(Line::INNER)], 12.6793, 5e-5);
  EXPECT_NEAR(orders[index(Line::OUTER_FAR_BELOW)], 6.3207, 5e-5);
}

/// Lines of 0.3 to 5 arcsec below encoder counts of 3 and 2.5 arcsec, at a speed that varies, must come out within 0.1
/// arcsec: eight standard errors.
void expectLinesRecovered(const std::function<double(double)>& speed)
{
  Synthetic joint(shippedParameters());
  joint.speed = speed;
  joint.error = [&](double angle, double)
  {
    return ARCSEC *
           (joint.line(Line::WAVE_GENERATOR_1, 2.0, 0.4, angle) + joint.line(Line::WAVE_GENERATOR_2, 5.0, 1.0, angle) +
            joint.line(Line::WAVE_GENERATOR_4, 1.5, -2.0, angle) +
            joint.line(Line::CIRCULAR_SPLINE_2, 0.8, 2.5, angle) + joint.line(Line::CAGE_LOBES, 0.5, 0.1, angle) +
            joint.line(Line::BALL, 0.3, 0.7, angle) + joint.line(Line::OUTER, 1.0, 0.0, angle) +
            joint.line(Line::INNER_DOUBLE, 0.6, 3.0, angle));
  };
  const SignalIndicators& found = joint.nextWindow();
  const auto amplitude = [&](Line line) { return found.amplitude(LineSignal::KINEMATIC_ERROR, line) / ARCSEC; };
  constexpr double TOLERANCE = 0.1;
  EXPECT_NEAR(amplitude(Line::WAVE_GENERATOR_1), 2.0, TOLERANCE);
  EXPECT_NEAR(amplitude(Line::WAVE_GENERATOR_2), 5.0, TOLERANCE);
  EXPECT_NEAR(amplitude(Line::WAVE_GENERATOR_4), 1.5, TOLERANCE);
  EXPECT_NEAR(amplitude(Line::CIRCULAR_SPLINE_2), 0.8, TOLERANCE);
  EXPECT_NEAR(amplitude(Line::CAGE_LOBES), 0.5, TOLERANCE);
  EXPECT_NEAR(amplitude(Line::BALL), 0.3, TOLERANCE);
  EXPECT_NEAR(amplitude(Line::OUTER), 1.0, TOLERANCE);
  EXPECT_NEAR(amplitude(Line::INNER_DOUBLE), 0.6, TOLERANCE);
  for (const Line line :
       { Line::BALL_BELOW, Line::OUTER_BELOW, Line::OUTER_ABOVE, Line::INNER, Line::WAVE_GENERATOR_8 })
  {
    EXPECT_LT(amplitude(line), TOLERANCE) << "line " << index(line);
  }
  EXPECT_NEAR(found.phase(LineSignal::KINEMATIC_ERROR, Line::WAVE_GENERATOR_2), 1.0, 0.02);
  EXPECT_NEAR(found.phase(LineSignal::KINEMATIC_ERROR, Line::CIRCULAR_SPLINE_2), 2.5, 0.12);
}

TEST(SignalMonitor, RecoversLinesBelowTheEncodersCountsAtVaryingSpeed)
{
  expectLinesRecovered([](double time) { return 100.0 + 60.0 * std::sin(0.9 * time); });
}

TEST(SignalMonitor, RecoversLinesFromAMotionBackAndForth)
{
  expectLinesRecovered([](double time) { return 150.0 * std::sin(0.8 * time); });
}

TEST(SignalMonitor, LeavesOutLinesTheTravelCannotTellApart)
{
  Synthetic joint(shippedParameters({ "indicators.window_turns=12.0" }));
  const SignalIndicators& found = joint.nextWindow();
  EXPECT_TRUE(std::isnan(found.amplitude(LineSignal::KINEMATIC_ERROR, Line::WAVE_GENERATOR_2)));
  EXPECT_TRUE(std::isnan(found.amplitude(LineSignal::KINEMATIC_ERROR, Line::CIRCULAR_SPLINE_2)));
  EXPECT_FALSE(std::isnan(found.amplitude(LineSignal::KINEMATIC_ERROR, Line::OUTER)));
}

TEST(SignalMonitor, LeavesOutLinesBeyondHalfTheSamples)
{
  Synthetic joint(shippedParameters());
  joint.speed = [](double) { return 230.0; };  // 55 samples a turn: orders up to 22
  const SignalIndicators& found = joint.nextWindow();
  EXPECT_TRUE(std::isnan(found.amplitude(LineSignal::MOTOR_TORQUE, Line::INNER_DOUBLE)));
  EXPECT_FALSE(std::isnan(found.amplitude(LineSignal::MOTOR_TORQUE, Line::INNER)));
}

/// Strokes of a joint to and fro, with a ripple of the motor angle: what the third filter leaves of it, and of the
/// changes of speed, a hundred thousand times as large, nothing.
class Strokes : public testing::Test
{
protected:
  static constexpr double SPEED = 35.0;   // [rad/s]
  static constexpr double RISE = 0.07;    // [s]
  static constexpr double STROKE = 4.0;   // [s]
  static constexpr double RIPPLE = 5e-5;  // [rad]; a count has 1.5e-3
  // A standard error of a line is 4e-6 rad: 4.2e-4 rad of a count, 20000 samples.
  static constexpr double TOLERANCE = 1.5e-5;  // [rad]

  Strokes()
  {
    joint_.speed = [](double time)
    {
      const double in_stroke = std::fmod(time, STROKE);
      const double share = std::min({ 1.0, in_stroke / RISE, (STROKE - in_stroke) / RISE });
      return (std::fmod(time, 2.0 * STROKE) < STROKE ? SPEED : -SPEED) * share;
    };
  }

  double found(Line line) const { return joint_.monitor.indicators().amplitude(LineSignal::MOTOR_RIPPLE, line); }

  /// Of a line's ripple, after the filter: what stays with the motor angle whichever way it turns (first), and what
  /// changes its sign with the direction, as the filter leads.
  std::array<double, 2> left(Line line)
  {
    const double filtered = joint_.orders[index(line)] * SPEED * 0.02;
    const double amplitude = std::pow(1.0 + 1.0 / (filtered * filtered), -1.5);
    const double lead = 3.0 * std::atan(1.0 / filtered);
    return { amplitude * std::abs(std::cos(lead)), amplitude * std::sin(lead) };
  }

  Synthetic joint_{ shippedParameters({ "indicators.window_turns=150.0" }) };
};

TEST_F(Strokes, RippleIsFoundBesideChangesOfSpeed)
{
  joint_.ripple = [&](double angle, double, double) { return RIPPLE * joint_.line(Line::INNER, 1.0, 0.3, angle); };
  joint_.nextWindow();
  EXPECT_NEAR(found(Line::INNER), RIPPLE * left(Line::INNER)[0], TOLERANCE);
  for (const Line line : { Line::WAVE_GENERATOR_2, Line::CAGE_LOBES, Line::BALL, Line::OUTER, Line::INNER_DOUBLE })
  {
    EXPECT_LT(found(line), TOLERANCE) << "line " << index(line);
  }
}

/// What rings on after each change of speed is a hundred times as large as the line, and as fast as order 6.
TEST_F(Strokes, RippleIsFoundBesideWhatRingsOn)
{
  joint_.ripple = [&](double angle, double, double time)
  {
    const double since = std::fmod(time, STROKE);
    return RIPPLE * joint_.line(Line::WAVE_GENERATOR_8, 1.0, 0.3, angle) +
           5e-3 * std::exp(-since / 0.45) * std::sin(6.0 * SPEED * since);
  };
  joint_.nextWindow();
  EXPECT_NEAR(found(Line::WAVE_GENERATOR_8), RIPPLE * left(Line::WAVE_GENERATOR_8)[0], TOLERANCE);
  for (const Line line : { Line::WAVE_GENERATOR_4, Line::WAVE_GENERATOR_6, Line::BALL, Line::OUTER })
  {
    EXPECT_LT(found(line), 2.0 * TOLERANCE) << "line " << index(line);
  }
}

TEST_F(Strokes, RippleInProportionToTheLoadIsALineOfItsOwn)
{
  const double rated = shippedParameters().life.rated_torque;
  constexpr double MEAN = 10.0;  // [N.m]
  joint_.load = [](double time) { return MEAN + 40.0 * std::sin(TWO_PI * time / 7.3); };
  joint_.ripple = [&](double angle, double load, double)
  { return 4.0 * RIPPLE * load / rated * joint_.line(Line::WAVE_GENERATOR_6, 1.0, 0.3, angle); };
  joint_.nextWindow();
  const auto [stays, turns] = left(Line::WAVE_GENERATOR_6);
  // The load spreads by 0.4 of the rated torque: the tolerance at that torque is larger by as much.
  EXPECT_NEAR(found(Line::WAVE_GENERATOR_6_LOAD), 4.0 * RIPPLE * stays, 2.4 * TOLERANCE);
  EXPECT_NEAR(found(Line::WAVE_GENERATOR_6_LOAD_LAG), 4.0 * RIPPLE * turns, 2.4 * TOLERANCE);
  EXPECT_NEAR(found(Line::WAVE_GENERATOR_6), 4.0 * RIPPLE * stays * MEAN / rated, TOLERANCE);
  EXPECT_LT(found(Line::WAVE_GENERATOR_4_LOAD), 2.4 * TOLERANCE);
  EXPECT_LT(found(Line::WAVE_GENERATOR_8_LOAD), 2.4 * TOLERANCE);
}

TEST_F(Strokes, ALoadThatStaysShowsNoLineInProportionToIt)
{
  joint_.load = [](double) { return 30.0; };
  joint_.nextWindow();
  EXPECT_TRUE(std::isnan(found(Line::WAVE_GENERATOR_6_LOAD)));
  EXPECT_FALSE(std::isnan(found(Line::WAVE_GENERATOR_6)));
}

TEST_F(Strokes, AMotionOneWayShowsNoLag)
{
  joint_.speed = [](double) { return SPEED; };
  joint_.load = [](double time) { return 40.0 * std::sin(TWO_PI * time / 7.3); };
  joint_.nextWindow();
  EXPECT_FALSE(std::isnan(found(Line::WAVE_GENERATOR_6_LOAD)));
  EXPECT_TRUE(std::isnan(found(Line::WAVE_GENERATOR_6_LOAD_LAG)));
}

TEST(SignalMonitor, FindsLinesInTheTorque)
{
  Synthetic joint(shippedParameters());
  joint.torque = [&](double angle, double)
  { return 0.15 + joint.line(Line::WAVE_GENERATOR_2, 0.004, 0.0, angle) + joint.line(Line::OUTER, 0.001, 0.0, angle); };
  const SignalIndicators& found = joint.nextWindow();
  EXPECT_NEAR(found.amplitude(LineSignal::MOTOR_TORQUE, Line::WAVE_GENERATOR_2), 0.004, 1e-6);
  EXPECT_NEAR(found.amplitude(LineSignal::MOTOR_TORQUE, Line::OUTER), 0.001, 1e-6);
  EXPECT_LT(found.amplitude(LineSignal::MOTOR_TORQUE, Line::INNER), 1e-6);
  EXPECT_NEAR(found[ScalarIndicator::RUNNING_TORQUE], 0.15, 1e-4);
}

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

/// A joint whose order-2 line and noise are healthy until told otherwise.
const int LEARNING = shippedParameters().indicators.baseline_windows;

class Assessed : public testing::Test
{
protected:
  Assessed()
  {
    joint_.error = [this](double angle, double)
    {
      return ARCSEC * (joint_.line(Line::WAVE_GENERATOR_2, 5.0, 1.0, angle) +
                       joint_.line(faulty_, fault_amplitude_, 2.5, angle) + noise_(random_));
    };
    joint_.torque = [this](double, double) { return 0.1 * drag_ + 0.001 * noise_(random_); };
  }

  const Assessment& windows(int count)
  {
    for (int i = 0; i < count; ++i)
    {
      assessor_.update(joint_.nextWindow());
    }
    return assessor_.assessment();
  }

  Line faulty_{ Line::WAVE_GENERATOR_2 };
  double fault_amplitude_{};
  double drag_{ 1.0 };
  std::mt19937 random_{ 11 };
  std::normal_distribution<double> noise_{ 0.0, 1.0 };
  Synthetic joint_{ shippedParameters() };
  Assessor assessor_{ shippedParameters() };
};

TEST_F(Assessed, HealthyJointIsLearnedAndStaysSilent)
{
  EXPECT_EQ(windows(LEARNING).state, AssessmentState::LEARNING);
  EXPECT_EQ(assessor_.assessment().windows_here, LEARNING);
  windows(4);
  for (int i = 0; i < 30; ++i)
  {
    const Assessment& assessment = windows(1);
    EXPECT_EQ(assessment.state, AssessmentState::ASSESSED);
    EXPECT_EQ(assessment.level, HealthLevel::OK);
    EXPECT_EQ(assessment.cause, Cause::NONE);
  }
}

TEST_F(Assessed, FewerWindowsThanAnotherLevelTakesAreNoVerdict)
{
  windows(LEARNING);
  drag_ = 3.0;
  for (int here = 1; here < 5; ++here)
  {
    const Assessment& assessment = windows(1);
    EXPECT_EQ(assessment.state, AssessmentState::TOO_FEW_WINDOWS);
    EXPECT_EQ(assessment.level, HealthLevel::OK);
    EXPECT_EQ(assessment.windows_here, here);
    EXPECT_EQ(assessment.windows_needed, 5);
    EXPECT_EQ(whyNotJudged(assessment),
              "too few windows: a verdict needs 5 at one operating point, has " + std::to_string(here));
  }
  EXPECT_EQ(windows(1).state, AssessmentState::ASSESSED);
  EXPECT_GE(assessor_.assessment().level, HealthLevel::WARN);
  EXPECT_EQ(whyNotJudged(assessor_.assessment()), "");
}

TEST_F(Assessed, CheckUpThatIsMadeOnceIsJudgedByItsOneWindow)
{
  Assessor once(shippedParameters({ "indicators.evidence_windows=1" }));
  windows(LEARNING);
  once.setReference(assessor_.baseline().bins());
  EXPECT_EQ(once.update(joint_.nextWindow()).state, AssessmentState::ASSESSED);
}

TEST_F(Assessed, ReferenceOfTooFewWindowsSaysHowManyItHas)
{
  windows(6);
  Assessor given(shippedParameters());
  given.setReference(assessor_.baseline().bins());
  const Assessment& assessment = given.update(joint_.nextWindow());
  EXPECT_EQ(assessment.state, AssessmentState::NO_REFERENCE);
  EXPECT_EQ(whyNotJudged(assessment), "the healthy reference needs 8 windows at this operating point, has 6");
}

TEST_F(Assessed, LineOfTheOuterRaceIsToldAndGoesAwayAgain)
{
  windows(LEARNING);
  faulty_ = Line::OUTER;
  fault_amplitude_ = 2.0;
  EXPECT_EQ(windows(4).level, HealthLevel::OK) << "three means of three windows or more";
  const Assessment faulty = windows(1);
  EXPECT_GE(faulty.level, HealthLevel::WARN);
  EXPECT_EQ(faulty.cause, causeOf(FaultKind::BEARING_OUTER_RACE));
  EXPECT_GT(faulty.confidence, 0.5);
  ASSERT_GT(faulty.evidence_count, 0U);
  EXPECT_STREQ(indicatorName(faulty.evidence[0].indicator), "error_outer");
  EXPECT_NEAR(faulty.evidence[0].value / ARCSEC, 2.0, 0.3);
  fault_amplitude_ = 0.0;
  EXPECT_GE(windows(4).level, HealthLevel::WARN);
  EXPECT_EQ(windows(8).level, HealthLevel::OK);
  EXPECT_EQ(assessor_.assessment().cause, Cause::NONE);
}

TEST_F(Assessed, LineAtAQuarterTurnFromTheHealthyOneIsSeenByItsPhase)
{
  windows(LEARNING);
  fault_amplitude_ = 1.5;  // at a right angle to the healthy 5 arcsec: the amplitude only grows to 5.2
  EXPECT_GE(windows(5).level, HealthLevel::WARN);
}

TEST_F(Assessed, OneWindowOfTenIsNoVerdict)
{
  windows(LEARNING + 9);
  drag_ = 3.0;
  EXPECT_LT(windows(1).largest_score, 1.0);
  drag_ = 1.0;
  EXPECT_LT(windows(1).largest_score, 1.0);
}

TEST_F(Assessed, WhatASingleWindowDoesNotShowTheMeanOfTenDoes)
{
  windows(LEARNING);
  faulty_ = Line::OUTER;
  fault_amplitude_ = 0.3;
  EXPECT_LT(windows(1).largest_score, 1.0);
  EXPECT_GE(windows(12).level, HealthLevel::WARN);
}

TEST_F(Assessed, DragIsPutDownToTheLubricant)
{
  windows(LEARNING);
  drag_ = 1.6;
  const Assessment& assessment = windows(5);
  EXPECT_GE(assessment.level, HealthLevel::WARN);
  EXPECT_EQ(assessment.cause, causeOf(FaultKind::LUBRICANT_DEGRADATION));
}

TEST_F(Assessed, TheVerdictIsTheSameWhenTheCauseIsSearchedForInParts)
{
  Assessor in_parts(shippedParameters());
  int searches = 0;
  for (int i = 0; i < LEARNING + 8; ++i)
  {
    drag_ = i < LEARNING ? 1.0 : 1.6;
    const SignalIndicators window = joint_.nextWindow();
    const Assessment whole = assessor_.update(window);
    const Assessment before = in_parts.assessment();
    const std::uint64_t allocations = allocationCount();
    in_parts.begin(window);
    std::size_t parts = 0;
    for (; in_parts.assessment().windows != whole.windows; ++parts)
    {
      ASSERT_EQ(in_parts.assessment().level, before.level);
      ASSERT_EQ(in_parts.assessment().cause, before.cause);
      in_parts.advance(100);
    }
    EXPECT_EQ(allocationCount(), allocations);
    const bool is_searching = whole.level != HealthLevel::OK && whole.largest_score > 1.0;
    EXPECT_EQ(parts, is_searching ? (in_parts.searchLength() + 99) / 100 : 0);
    searches += is_searching ? 1 : 0;
    const Assessment& found = in_parts.assessment();
    EXPECT_EQ(found.level, whole.level);
    EXPECT_EQ(found.cause, whole.cause);
    EXPECT_EQ(found.confidence, whole.confidence);
    EXPECT_EQ(found.severity, whole.severity);
    EXPECT_EQ(found.severity_deviation, whole.severity_deviation);
    EXPECT_EQ(found.evidence[0].score, whole.evidence[0].score);
  }
  EXPECT_GT(searches, 2);
}

TEST_F(Assessed, OtherSpeedIsNotComparedWithThisOne)
{
  windows(LEARNING);
  joint_.speed = [](double) { return 30.0; };
  drag_ = 0.5;
  windows(1);  // the window that begins at the old speed
  EXPECT_EQ(windows(1).state, AssessmentState::LEARNING);
  EXPECT_EQ(assessor_.assessment().level, HealthLevel::OK);
}

/// Windows of a sound joint at any temperature: friction and stiffness go with it, the stiffness with a spread of its
/// own.
class AtAnyTemperature : public testing::Test
{
protected:
  AtAnyTemperature()
  {
    for (int window = 0; window < LEARNING; ++window)
    {
      assess(normal_(random_), normal_(random_));
    }
  }

  const Assessment& assess(double temperature, double stiffness)
  {
    SignalIndicators window;
    window.point = { 100.0, 1.0, 30.0, 25.0 };
    window.values[indexOf(ScalarIndicator::RUNNING_TORQUE)] = 0.15 - 0.02 * temperature + noise();
    window.values[indexOf(ScalarIndicator::COULOMB_TORQUE)] = 0.10 - 0.01 * temperature + noise();
    window.values[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)] = 25000.0 + 300.0 * temperature + 10.0 * stiffness;
    const std::uint64_t before = allocationCount();
    assessor_.update(window);
    EXPECT_EQ(allocationCount(), before);
    return assessor_.assessment();
  }

  /// After ten windows whose stiffness lies so many spreads off, by more and less in turn.
  HealthLevel levelAfter(double off, double scatter)
  {
    for (int window = 0; window < 10; ++window)
    {
      assess(0.0, off + (window % 2 == 0 ? scatter : -scatter));
    }
    return assessor_.assessment().level;
  }

  double noise() { return 1e-4 * normal_(random_); }

  Assessor assessor_{ shippedParameters({ "indicators.least_spread=0.0" }) };
  std::mt19937 random_{ 7 };
  std::normal_distribution<double> normal_;
};

TEST_F(AtAnyTemperature, WhatTemperatureMovesTogetherIsNoFault)
{
  EXPECT_LT(assess(2.0, 0.0).largest_score, 1.0);
  EXPECT_LT(assess(-2.0, 1.0).largest_score, 1.0);
}

TEST_F(AtAnyTemperature, AMeanFarFromTheReferenceIsAFault)
{
  EXPECT_NE(levelAfter(1200.0, 0.0), HealthLevel::OK);
}

TEST_F(AtAnyTemperature, AMeanOfWindowsThatScatterFarMoreIsNone)
{
  EXPECT_EQ(levelAfter(1200.0, 3000.0), HealthLevel::OK);
}

/// Score of a window whose running torque lies `off` beside what it falls by with the temperature, learned from windows
/// spread by `range` about 25 degC.
double scoreAt(double temperature, double off, double range)
{
  Assessor assessor(shippedParameters());
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> between(-range, range);
  const auto assess = [&](double at, double beside)
  {
    SignalIndicators window;
    window.point = { 100.0, 1.0, 30.0, at };
    window.values[indexOf(ScalarIndicator::RUNNING_TORQUE)] =
        0.15 - 0.002 * (at - 25.0) + 1e-4 * normal(random) + beside;
    assessor.update(window);
  };
  for (int window = 0; window < LEARNING; ++window)
  {
    assess(25.0 + between(random), 0.0);
  }
  assess(temperature, off);
  return assessor.assessment().largest_score;
}

TEST(Reference, FollowsTheTemperatureWithinAClass)
{
  EXPECT_LT(scoreAt(28.0, 0.0, 4.0), 1.0);
  EXPECT_GT(scoreAt(28.0, 0.002, 4.0), 1.0) << "a third of what the temperature makes";
}

TEST(Reference, OfOneTemperatureCallsNothingAFaultAtAnother)
{
  EXPECT_LT(scoreAt(28.0, 0.0, 0.05), 1.0);
  EXPECT_GT(scoreAt(25.0, 0.002, 0.05), 1.0);
}

/// Running torques that rise with the payload, with 1e-4 N.m of noise; every sixth window may lack them.
class WithPayloads : public testing::Test
{
protected:
  static constexpr double RISE = 2e-4;  // [1]

  double scoreAt(double temperature, double payload, double off)
  {
    SignalIndicators window;
    window.windows = ++windows_;
    window.point = { 100.0, 1.0, 30.0, temperature, 0.0, payload, 0.0, 4.0 };
    if (!lacking_ || windows_ % 6 != 3)
    {
      window.values[indexOf(ScalarIndicator::RUNNING_TORQUE)] = 0.15 + RISE * payload + 1e-4 * normal_(random_) + off;
    }
    assessor_.update(window);
    return assessor_.assessment().largest_score;
  }

  void learn(double temperature, double range)
  {
    std::uniform_real_distribution<double> between(-range, range);
    for (int window = 0; window < LEARNING; ++window)
    {
      scoreAt(temperature, between(random_), 0.0);
    }
  }

  bool lacking_{};

private:
  Assessor assessor_{ shippedParameters() };
  std::uint64_t windows_{};
  std::mt19937 random_{ 3 };
  std::normal_distribution<double> normal_;
};

TEST_F(WithPayloads, ThoseLearnedAtOneTemperatureServeAtAnother)
{
  learn(25.0, 10.0);
  learn(35.0, 0.5);
  EXPECT_LT(scoreAt(35.0, 10.0, 0.0), 1.0);
  EXPECT_GT(scoreAt(35.0, 10.0, 15.0 * RISE), 1.0);
}

TEST_F(WithPayloads, ThoseNeverLearnedCallNothingAFault)
{
  learn(35.0, 0.5);
  EXPECT_LT(scoreAt(35.0, 10.0, 15.0 * RISE), 1.0);
}

TEST_F(WithPayloads, CountForAnIndicatorThatSomeWindowsLack)
{
  lacking_ = true;
  learn(25.0, 10.0);
  EXPECT_LT(scoreAt(25.0, 9.0, 0.0), 1.0);
  EXPECT_GT(scoreAt(25.0, 9.0, 15.0 * RISE), 1.0) << "less than from one payload to another";
}

/// Variance of the mean of ten sound windows, over that of one, of a reference of `runs` stretches of ten windows whose
/// values share `shared` of their spread.
double varianceOfTen(double shared, int runs)
{
  Parameters parameters = shippedParameters({ "indicators.least_spread=0.0" });
  parameters.indicators.baseline_windows = 10 * runs;
  const auto own = [&](int evidence_windows)
  {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    parameters.indicators.evidence_windows = evidence_windows;
    Assessor assessor(parameters);
    for (int run = 0; run <= runs; ++run)
    {
      const double stays = std::sqrt(shared) * normal(random);
      for (int i = 1; i <= 10; ++i)
      {
        SignalIndicators window;
        window.windows = static_cast<std::uint64_t>(i);
        window.point = { 100.0, 1.0, 30.0, 25.0 };
        window.values[indexOf(ScalarIndicator::RUNNING_TORQUE)] =
            0.15 + 1e-3 * (stays + std::sqrt(1.0 - shared) * normal(random));
        assessor.update(window);
      }
    }
    return assessor.baseline().residual().own[indexOf(ScalarIndicator::RUNNING_TORQUE)];
  };
  return own(10) / own(1);
}

TEST(Reference, OfIndependentWindowsMakesTheMeanOfTenNearlyTenTimesAsSure)
{
  EXPECT_NEAR(varianceOfTen(0.0, 60), 1.0 / 8.0, 0.12);
}

TEST(Reference, OfWindowsAlikeWithinARunDoesNot)
{
  EXPECT_NEAR(varianceOfTen(0.8, 60), 0.8, 0.15);
}

TEST(Level, IsNotRefutedAtAnotherOperatingPoint)
{
  Assessor assessor(shippedParameters());
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto assess = [&](int windows, double temperature, double beside)
  {
    for (int i = 0; i < windows; ++i)
    {
      SignalIndicators window;
      window.point = { 100.0, 1.0, 30.0, temperature };
      window.values[indexOf(ScalarIndicator::RUNNING_TORQUE)] = 0.15 + 1e-4 * normal(random) + beside;
      assessor.update(window);
    }
    return assessor.assessment().level;
  };
  assess(LEARNING, 25.0, 0.0);
  assess(LEARNING, 35.0, 0.0);
  EXPECT_EQ(assess(4, 25.0, 0.01), HealthLevel::OK);
  EXPECT_GE(assess(1, 25.0, 0.01), HealthLevel::WARN);
  EXPECT_GE(assess(20, 35.0, 0.0), HealthLevel::WARN);
  EXPECT_EQ(assess(12, 25.0, 0.0), HealthLevel::OK);
}

TEST(Reference, KeepsTheSoundValueWhereAModelIsSubtracted)
{
  Assessor assessor(shippedParameters());
  SignalIndicators model;
  model.values[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)] = 25000.0;
  for (int window = 0; window <= LEARNING; ++window)
  {
    SignalIndicators measured = model;
    measured.point = { 100.0, 1.0, 30.0, 25.0 };
    measured.values[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)] = window < LEARNING ? 24000.0 : 21600.0;
    assessor.update(difference(measured, model), &model);
  }
  const WindowResidual& residual = assessor.baseline().residual();
  EXPECT_DOUBLE_EQ(residual.sound[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)], 24000.0);
  EXPECT_DOUBLE_EQ(residual.difference[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)], -2400.0);
}

/// A reference of a motion to and fro that is carried to one of twice the speed and three times the load.
class CarriedReference : public testing::Test
{
protected:
  CarriedReference()
  {
    for (int window = 0; window < LEARNING; ++window)
    {
      update(learned_, { 80.0, 0.0, 20.0, 25.0 + normal_(random_) }, normal_(random_));
    }
    carried_.setReference(learned_.baseline().bins(), true);
  }

  const Assessment& update(Assessor& assessor, const OperatingPoint& point, double stiffness_error)
  {
    SignalIndicators model;
    model.values[STIFFNESS] = model_stiffness_;
    model.values[TORQUE] = 0.1 + 0.001 * point.load;
    SignalIndicators measured = model;
    measured.point = point;
    measured.values[STIFFNESS] = 30000.0 + stiffness_error;
    measured.values[TORQUE] += 1e-4 * normal_(random_);
    return assessor.update(difference(measured, model), &model);
  }

  const Assessment& tenWindows(Assessor& assessor, const OperatingPoint& point, double stiffness_error)
  {
    for (int window = 0; window < 10; ++window)
    {
      update(assessor, point, stiffness_error + normal_(random_));
    }
    return assessor.assessment();
  }

  static constexpr std::size_t STIFFNESS = indexOf(ScalarIndicator::TORSIONAL_STIFFNESS);
  static constexpr std::size_t TORQUE = indexOf(ScalarIndicator::RUNNING_TORQUE);
  static constexpr OperatingPoint OTHER{ 160.0, 0.0, 60.0, 25.0 };

  const CarriedError error_of_others_ = shippedSignatures()->carried[STIFFNESS];
  const double carried_error_ = std::hypot(error_of_others_.deviation, error_of_others_.share * 1000.0);
  double model_stiffness_{ 29000.0 };  // the drive's is 30000
  std::mt19937 random_{ 7 };
  std::normal_distribution<double> normal_;
  Assessor learned_{ shippedParameters() };
  Assessor carried_{ shippedParameters() };
};

TEST_F(CarriedReference, JudgesAMotionThatHasNone)
{
  EXPECT_EQ(tenWindows(carried_, OTHER, 0.0).state, AssessmentState::ASSESSED);
  EXPECT_EQ(carried_.assessment().level, HealthLevel::OK);
  EXPECT_NEAR(carried_.baseline().residual().sound[STIFFNESS], 30000.0, 1.0);
  EXPECT_NEAR(carried_.baseline().residual().difference[TORQUE], 0.0, 1e-4);
  Assessor own(shippedParameters());
  own.setReference(learned_.baseline().bins());
  EXPECT_EQ(tenWindows(own, OTHER, 0.0).state, AssessmentState::NO_REFERENCE);
}

TEST_F(CarriedReference, IsOffByWhatOtherGearsWere)
{
  EXPECT_EQ(tenWindows(carried_, OTHER, 3.0 * carried_error_).level, HealthLevel::OK);
  EXPECT_EQ(tenWindows(carried_, OTHER, -40.0 * carried_error_).level, HealthLevel::ERROR);
  EXPECT_EQ(carried_.assessment().evidence[0].indicator, STIFFNESS);
}

TEST_F(CarriedReference, IsOfTheSameTemperatureAndOfMotionsToAndFro)
{
  EXPECT_EQ(tenWindows(carried_, { 160.0, 0.0, 60.0, 45.0 }, 0.0).state, AssessmentState::NO_REFERENCE);
  EXPECT_EQ(tenWindows(carried_, { 160.0, 1.0, 60.0, 25.0 }, 0.0).state, AssessmentState::NO_REFERENCE);
}

TEST_F(CarriedReference, LeavesOutOfTheCauseWhatTheModelDidNotDetermine)
{
  tenWindows(carried_, OTHER, -40.0 * carried_error_);
  model_stiffness_ = std::numeric_limits<double>::quiet_NaN();
  const Assessment& assessment = update(carried_, OTHER, 0.0);
  EXPECT_GT(assessment.largest_score, 1.0);
  EXPECT_EQ(carried_.baseline().residual().own[STIFFNESS], 0.0);
  EXPECT_TRUE(std::isfinite(assessment.confidence));
}

/// A window that differs from its reference by noise, and by a signature where one is given.
class AgainstSignatures : public testing::Test
{
protected:
  const std::shared_ptr<const SignatureSet> signatures_ = shippedSignatures();

  AgainstSignatures()
  {
    // A hundredth of the largest change in any signature.
    for (const Signature& signature : signatures_->signatures)
    {
      for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
      {
        spread_[i] = std::max(spread_[i], 0.01 * std::abs(signature.change[i]));
      }
    }
  }

  CausePosterior posterior(const std::array<double, SIGNATURE_SIZE>& change, const MotionKind& motion)
  {
    OperatingPoint point;
    point.speed = motion.speed;
    point.direction = -motion.direction;
    WindowResidual window;
    window.freedom = 40.0;
    const auto put = [&](std::size_t indicator, double value, double spread)
    {
      window.difference[indicator] = value + spread * normal_(random_);
      window.own[indicator] = spread * spread;
    };
    for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
    {
      put(i, change[i], spread_[i]);
      window.sound[i] = 1.0;  // shares of it are in its unit
    }
    for (const LineSignal signal : ALL_LINE_SIGNALS)
    {
      for (std::size_t line = 0; line < LINE_COUNT && hasLine(signal, line); ++line)
      {
        const std::size_t number = signatureNumber(signal, line);
        if (isPhaseLocked(line))
        {
          const double phase = TWO_PI * phase_(random_);
          put(cosineIndex(signal, line), change[number] * std::cos(phase), spread_[number]);
          put(sineIndex(signal, line), change[number] * std::sin(phase), spread_[number]);
        }
        put(amplitudeIndex(signal, line), change[number], spread_[number]);
      }
    }
    const std::uint64_t before = allocationCount();
    search_.start();
    search_.advance(window, point, search_.signatures());
    const CausePosterior found = search_.posterior();
    EXPECT_EQ(allocationCount(), before);
    return found;
  }

  static double sum(const CausePosterior& posterior)
  {
    return std::accumulate(posterior.probability.begin(), posterior.probability.end(), 0.0);
  }

  /// Of its changes, in spreads: in some motions a fault changes next to nothing.
  double strength(const Signature& signature) const
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
    {
      sum = std::hypot(sum, spread_[i] > 0.0 ? signature.change[i] / spread_[i] : 0.0);
    }
    return sum;
  }

  CauseSearch search_{ signatures_ };
  std::array<double, SIGNATURE_SIZE> spread_{};
  std::mt19937 random_{ 5 };
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> phase_{ 0.0, 1.0 };
};

TEST_F(AgainstSignatures, EveryCauseIsAmongTheMostLikelyOfItsOwnSignature)
{
  for (const Signature& signature : signatures_->signatures)
  {
    if (signature.severity < 0.4 || strength(signature) < 10.0)
    {
      continue;
    }
    const CausePosterior found = posterior(signature.change, signature.motion);
    EXPECT_NEAR(sum(found), 1.0, 1e-9);
    const auto own = static_cast<std::size_t>(signature.cause);
    int before = 0;
    for (const double probability : found.probability)
    {
      before += probability > found.probability[own] ? 1 : 0;
    }
    // Single teeth, and the two cracks of the cup, change the same.
    EXPECT_LE(before, 3) << causeName(signature.cause) << " at " << signature.severity;
    // Of a line reasoned by kinematics alone, too few numbers speak for the severity.
    const auto numbers =
        std::count_if(signature.change.begin(), signature.change.end(), [](double change) { return change != 0.0; });
    if (before == 0 && numbers > 2)
    {
      // One step of the table, or what the error of the signatures makes.
      constexpr double STEP = 1.7;
      const double deviation = 3.0 * found.severity_deviation[own];
      EXPECT_GT(found.severity[own], std::min(signature.severity / STEP, signature.severity - deviation))
          << causeName(signature.cause);
      EXPECT_LT(found.severity[own], std::max(signature.severity * STEP, signature.severity + deviation))
          << causeName(signature.cause);
    }
  }
}

TEST_F(AgainstSignatures, OfAMotionLikeTheWindowsCountMore)
{
  double alike = 0.0;
  double other = 0.0;
  for (const Signature& signature : signatures_->signatures)
  {
    if (signature.motion.speed > 0.0 && strength(signature) > 10.0)
    {
      const auto own = static_cast<std::size_t>(signature.cause);
      const MotionKind far{ 3.0 * signature.motion.speed, 1.0 - signature.motion.direction };
      alike += posterior(signature.change, signature.motion).probability[own];
      other += posterior(signature.change, far).probability[own];
    }
  }
  EXPECT_GT(alike, 1.05 * other);
}

TEST_F(AgainstSignatures, WhatMovesEverythingAtRandomIsNoneOfThem)
{
  std::array<double, SIGNATURE_SIZE> change{};
  for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
  {
    change[i] = (i % 2 == 0 ? 20.0 : -20.0) * spread_[i];
  }
  const CausePosterior found = posterior(change, ANY_MOTION);
  EXPECT_GT(found.probability[static_cast<std::size_t>(Cause::NONE)], 0.9);
}

/// The twin held at 150 rad/s under a load that swings; its indicators of the second window of 30 turns.
SignalIndicators twinIndicators(std::vector<std::string> edits)
{
  edits.insert(edits.end(), { "indicators.window_turns=30.0", "output.load_inertia=0.5" });
  Twin twin(shippedParameters(edits));
  twin.watchSignals(true);
  double held_back = 0.0;  // integral part of the speed control [N.m]
  const double step = 1e-9 * static_cast<double>(twin.stepLength());
  while (twin.signalIndicators().windows < 2)
  {
    const double missing = 150.0 - twin.outputs().motor_velocity;
    held_back += 0.2 * missing * step;
    twin.commandMotorTorque(twin.stamp() + twin.stepLength(), 0.02 * missing + held_back);
    twin.commandLoadTorque(twin.stamp() + twin.stepLength(),
                           12.0 * std::sin(TWO_PI * 3.0 * 1e-9 * static_cast<double>(twin.stamp())));
    twin.step(twin.stamp() + twin.stepLength());
  }
  return twin.signalIndicators();
}

TEST(TwinsIndicators, FollowPhysicalEdits)
{
  const SignalIndicators healthy = twinIndicators({});
  const double stiffness = healthy[ScalarIndicator::TORSIONAL_STIFFNESS];
  EXPECT_GT(stiffness, 20e3);
  EXPECT_LT(stiffness, 50e3);
  // The load swings by less than 1 mrad of torsion, the output turns by 62 mrad in a motor turn, 30 of them.
  EXPECT_NEAR(healthy[ScalarIndicator::RATIO_DEVIATION], 0.0, 5e-4);

  const SignalIndicators soft_cup = twinIndicators({ "cup.torsion_stiffness=[26.0e+3, 45.4e+3, 52.3e+3]" });
  EXPECT_LT(soft_cup[ScalarIndicator::TORSIONAL_STIFFNESS], 0.95 * stiffness);

  const SignalIndicators thick_grease = twinIndicators({ "motor.viscous_friction=1.066e-3" });
  EXPECT_NEAR(thick_grease[ScalarIndicator::RUNNING_TORQUE] - healthy[ScalarIndicator::RUNNING_TORQUE], 0.15, 0.03);

  const SignalIndicators worn_teeth = twinIndicators({ "mesh.flank_clearance=5.0e-6" });
  EXPECT_GT(worn_teeth[ScalarIndicator::LOST_MOTION], healthy[ScalarIndicator::LOST_MOTION]);
}

TEST(OperatingBin, StepsWithTheGearsTorqueAndTakesAnyNumber)
{
  const Parameters parameters = shippedParameters();
  const Parameters wrist = shippedParameters({}, { "size_14" });
  OperatingPoint point;
  point.speed = 100.0;
  const auto bin_at = [&](const Parameters& gear, double share)
  {
    point.load = share * gear.life.rated_torque;
    return binOf(point, loadStep(gear)).load;
  };
  for (const double share : { -1.3, 0.1, 0.5, 2.0 })
  {
    EXPECT_EQ(bin_at(parameters, share), bin_at(wrist, share)) << share;
  }
  EXPECT_LT(loadStep(wrist), 0.2 * loadStep(parameters));
  for (const double huge : { 6.7e305, -6.7e305, HUGE_VAL, std::nan("") })
  {
    point.load = point.temperature = point.speed = huge;
    const OperatingBin bin = binOf(point, loadStep(parameters));
    EXPECT_LE(std::abs(bin.load), 1'000'000) << huge;
    EXPECT_LE(std::abs(bin.temperature), 1'000'000) << huge;
    EXPECT_LE(std::abs(bin.speed), 1100) << huge;
  }
}
}  // namespace
}  // namespace hjt
