// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <complex>
#include <map>
#include <utility>

#include "test/core/signal_monitor_support.hpp"
#include "test/support/seeded_random.hpp"

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

TEST(SignalMonitor, GivesNeitherStiffnessNorKindsOfFrictionAtOneLoadAndSpeed)
{
  Synthetic joint(shippedParameters());
  joint.load = [](double) { return 5.0; };
  const SignalIndicators& found = joint.nextWindow();
  for (const ScalarIndicator none :
       { ScalarIndicator::TORSIONAL_STIFFNESS, ScalarIndicator::LOST_MOTION, ScalarIndicator::HYSTERESIS_AREA,
         ScalarIndicator::COULOMB_TORQUE, ScalarIndicator::VISCOUS_FRICTION })
  {
    EXPECT_TRUE(std::isnan(found[none])) << indicatorName(indexOf(none));
  }
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
    SeededRandom random(7);
    std::uint64_t count = 0;
    joint.error = [&](double, double) { return 2e-6 * random.normal() + (++count % 100 == 0 ? impulse : 0.0); };
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
  const SignalIndicators found = windowOfSamples({},
                                                 [](int i, SignalSample& sample)
                                                 {
                                                   sample.stamp = i * SAMPLE;
                                                   sample.output_angle = 100.0 / RATIO * 1e-9 * SAMPLE * i;
                                                   sample.motor_torque =
                                                       0.1 + 0.01 * std::cos(4.0 * RATIO * sample.output_angle);
                                                 });
  EXPECT_NEAR(found.amplitude(LineSignal::MOTOR_TORQUE, Line::WAVE_GENERATOR_4), 0.01, 1e-5);
  EXPECT_TRUE(std::isnan(found.amplitude(LineSignal::KINEMATIC_ERROR, Line::WAVE_GENERATOR_4)));
  EXPECT_TRUE(std::isnan(found.amplitude(LineSignal::MOTOR_RIPPLE, Line::WAVE_GENERATOR_4)));
  EXPECT_TRUE(std::isnan(found[ScalarIndicator::KINEMATIC_ERROR]));
}

/// A robot's joint at 125 Hz, one encoder, to and fro at up to 120 rad/s of the motor under a load: friction by load.
double loadFriction(double share)
{
  const SignalIndicators found =
      windowOfSamples({ "indicators.window_turns=1e5", "indicators.window_time=20.0" },
                      [share](int i, SignalSample& sample)
                      {
                        const double time = 8e-3 * i;
                        sample.stamp = i * std::int64_t{ 8000000 };
                        sample.output_angle = std::sin(1.2 * time);
                        sample.load_torque = 60.0 * std::sin(sample.output_angle) + 8.0;
                        const double speed = 1.2 * RATIO * std::cos(1.2 * time);
                        sample.motor_torque = sample.load_torque / RATIO + 4e-4 * speed +
                                              std::copysign(0.1 + share * std::abs(sample.load_torque) / RATIO, speed);
                      });
  return found[ScalarIndicator::LOAD_FRICTION];
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
  return windowOfSamples({ "indicators.window_turns=240" },
                         [=](int i, SignalSample& sample)
                         {
                           sample.stamp = i * SAMPLE;
                           const double angle = SPEED * 1e-9 * SAMPLE * i;
                           const double sign = std::fmod(angle / TWO_PI / turns, 2.0) < 1.0 ? 1.0 : -1.0;
                           sample.output_angle = (angle + sign * line * std::cos(2.0 * angle)) / RATIO;
                           sample.target_angle = has_set_points ? angle / RATIO : std::nan("");
                           sample.motor_torque = 0.1;
                         });
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
  const SignalIndicators found =
      windowOfSamples({ "indicators.window_turns=25.0" },
                      [](int i, SignalSample& sample)
                      {
                        sample.stamp = i * std::int64_t{ 8000000 };
                        sample.output_angle = 105.8 / RATIO * 8e-3 * i;
                        sample.motor_torque = 0.1 + 0.014 * std::cos(2.0 * (RATIO - 1.0) * sample.output_angle);
                      });
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
      return NOISE * generator_.normal() + amplitude * (std::cos(orders_[index(Line::OUTER)] * angle + 1.0) +
                                                        std::cos(orders_[index(Line::OUTER_BELOW)] * angle));
    };
  }
  /// Amplitude found of the outer race's line in the next window [rad].
  double outer() { return joint_.nextWindow().amplitude(LineSignal::MOTOR_RIPPLE, Line::OUTER); }

private:
  static constexpr double NOISE = 1e-4;  // [rad]
  static Parameters parameters() { return shippedParameters({ "indicators.window_turns=42.0" }); }

  SeededRandom generator_;
  LineOrders orders_;
  Synthetic joint_;
};

TEST(BearingSlip, LinesOfABearingThatSlipsAreFoundWhereTheyAre)
{
  constexpr double AMPLITUDE = 2e-5;
  for (const double slip : { 0.0, 0.004, 0.0131, 0.0257 })
  {
    EXPECT_NEAR(SlippingJoint(true, slip, AMPLITUDE, 3).outer(), AMPLITUDE, 0.2 * AMPLITUDE) << slip;
    EXPECT_TRUE(slip == 0.0 || SlippingJoint(false, slip, AMPLITUDE, 3).outer() < 0.5 * AMPLITUDE) << slip;
  }
}

/// Where lines of the teeth, folded by the sampling, would pass for those of a bearing that slips.
TEST(BearingSlip, NoneIsSoughtAtAnEvenSpeed)
{
  EXPECT_EQ(SlippingJoint(true, 0.0131, 2e-5, 3, 1.0).outer(), SlippingJoint(false, 0.0131, 2e-5, 3, 1.0).outer());
}

TEST(BearingSlip, NoneIsFoundInNoise)
{
  SlippingJoint sought(true, 0.0, 0.0, 7);
  SlippingJoint without(false, 0.0, 0.0, 7);
  for (int window = 0; window < 100; ++window)
  {
    EXPECT_EQ(sought.outer(), without.outer()) << window;
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
  const std::map<Line, std::pair<double, double>> lines{ // amplitude [arcsec] and phase [rad]
                                                         { Line::WAVE_GENERATOR_1, { 2.0, 0.4 } },
                                                         { Line::WAVE_GENERATOR_2, { 5.0, 1.0 } },
                                                         { Line::WAVE_GENERATOR_4, { 1.5, -2.0 } },
                                                         { Line::CIRCULAR_SPLINE_2, { 0.8, 2.5 } },
                                                         { Line::CAGE_LOBES, { 0.5, 0.1 } },
                                                         { Line::BALL, { 0.3, 0.7 } },
                                                         { Line::OUTER, { 1.0, 0.0 } },
                                                         { Line::INNER_DOUBLE, { 0.6, 3.0 } },
                                                         { Line::BALL_BELOW, {} },
                                                         { Line::OUTER_BELOW, {} },
                                                         { Line::OUTER_ABOVE, {} },
                                                         { Line::INNER, {} },
                                                         { Line::WAVE_GENERATOR_8, {} }
  };
  joint.error = [&](double angle, double)
  {
    double sum = 0.0;
    for (const auto& [line, wave] : lines)
    {
      sum += ARCSEC * joint.line(line, wave.first, wave.second, angle);
    }
    return sum;
  };
  const SignalIndicators& found = joint.nextWindow();
  for (const auto& [line, wave] : lines)
  {
    EXPECT_NEAR(found.amplitude(LineSignal::KINEMATIC_ERROR, line) / ARCSEC, wave.first, 0.1) << "line " << index(line);
  }
  EXPECT_NEAR(found.phase(LineSignal::KINEMATIC_ERROR, Line::WAVE_GENERATOR_2), 1.0, 0.02);
  EXPECT_NEAR(found.phase(LineSignal::KINEMATIC_ERROR, Line::CIRCULAR_SPLINE_2), 2.5, 0.12);
}

/// Turning on, and back and forth.
TEST(SignalMonitor, RecoversLinesBelowTheEncodersCountsAtVaryingSpeed)
{
  expectLinesRecovered([](double time) { return 100.0 + 60.0 * std::sin(0.9 * time); });
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
