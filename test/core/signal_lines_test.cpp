// SPDX-License-Identifier: BSD-3-Clause
#include "health/signal_monitor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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

/// Else a fault that changes the friction would pass for another payload, which the reference's slopes follow.
TEST(OperatingPoint, HasNoFrictionInItsInertia)
{
  for (const bool load_known : { true, false })
  {
    const double without = swing(1.2, 0.0, load_known).inertia;
    EXPECT_NEAR(swing(1.2, 0.3, load_known).inertia, without, 0.02) << load_known;
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

TEST(TrackedOrders, OfABearingThatSlipsAreThoseOfSlowerCageAndBalls)
{
  constexpr double SLIP = 0.02;
  const Parameters parameters = shippedParameters();
  const LineOrders without = trackedOrders(parameters.gear, parameters.bearing);
  const LineOrders with = trackedOrders(parameters.gear, parameters.bearing, SLIP);
  const auto of = [](const LineOrders& orders, Line line) { return orders[index(line)]; };
  EXPECT_NEAR(of(with, Line::OUTER), (1.0 - SLIP) * of(without, Line::OUTER), 1e-12);
  EXPECT_NEAR(of(with, Line::BALL), (1.0 - SLIP) * of(without, Line::BALL), 1e-12);
  EXPECT_NEAR(of(with, Line::OUTER) + of(with, Line::INNER), parameters.bearing.balls, 1e-12);
  EXPECT_EQ(of(with, Line::WAVE_GENERATOR_2), of(without, Line::WAVE_GENERATOR_2));
}

/// Window of a joint in noise whose bearing slips, its outer race and its line two orders below at an amplitude [rad].
class SlippingJoint
{
public:
  /// `speed_change`: of the motor [rad/s].
  SlippingJoint(bool is_sought, double slip, double amplitude, unsigned seed, double speed_change = 20.0)
    : generator_(seed), orders_(trackedOrders(parameters().gear, parameters().bearing, slip)), joint_(parameters())
  {
    if (is_sought)
    {
      joint_.monitor.seekBearingSlip(parameters());
    }
    joint_.quantised = false;
    joint_.speed = [speed_change](double time) { return 100.0 + speed_change * std::sin(3.0 * time); };
    joint_.ripple = [this, amplitude](double angle, double, double)
    {
      return NOISE * normal_(generator_) + amplitude * (std::cos(orders_[index(Line::OUTER)] * angle + 1.0) +
                                                        std::cos(orders_[index(Line::OUTER_BELOW)] * angle));
    };
  }
  const SignalIndicators& window() { return joint_.nextWindow(); }

private:
  static constexpr double NOISE = 1e-4;  // [rad]
  static Parameters parameters() { return shippedParameters({ "indicators.window_turns=42.0" }); }

  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
  LineOrders orders_;
  Synthetic joint_;
};

TEST(BearingSlip, LinesOfABearingThatSlipsAreFoundWhereTheyAre)
{
  constexpr double AMPLITUDE = 2e-5;
  for (const double slip : { 0.0, 0.004, 0.0131, 0.0257 })
  {
    const auto found = [&](bool is_sought)
    { return SlippingJoint(is_sought, slip, AMPLITUDE, 3).window().amplitude(LineSignal::MOTOR_RIPPLE, Line::OUTER); };
    EXPECT_NEAR(found(true), AMPLITUDE, 0.2 * AMPLITUDE) << slip;
    EXPECT_TRUE(slip == 0.0 || found(false) < 0.5 * AMPLITUDE) << slip;
  }
}

/// Where lines of the teeth, folded by the sampling, would pass for those of a bearing that slips.
TEST(BearingSlip, NoneIsSoughtAtAnEvenSpeed)
{
  const auto found = [](bool is_sought)
  { return SlippingJoint(is_sought, 0.0131, 2e-5, 3, 1.0).window().amplitude(LineSignal::MOTOR_RIPPLE, Line::OUTER); };
  EXPECT_EQ(found(true), found(false));
}

TEST(BearingSlip, NoneIsFoundInNoise)
{
  SlippingJoint sought(true, 0.0, 0.0, 7);
  SlippingJoint without(false, 0.0, 0.0, 7);
  for (int window = 0; window < 100; ++window)
  {
    const SignalIndicators found = sought.window();
    EXPECT_EQ(found.amplitude(LineSignal::MOTOR_RIPPLE, Line::OUTER),
              without.window().amplitude(LineSignal::MOTOR_RIPPLE, Line::OUTER))
        << window;
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
}  // namespace
}  // namespace hjt
