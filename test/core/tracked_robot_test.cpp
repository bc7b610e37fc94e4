// SPDX-License-Identifier: BSD-3-Clause
// The twin beside measured rows: what a stream does to it, which load it reckons with, how it judges time.
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "test_parameters.hpp"

#include "test/core/tracker_support.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/telemetry_fit.hpp"
#include "tracking/telemetry_rows.hpp"
#include "tracking/tracker.hpp"
#include "tracking/verdict_watch.hpp"

namespace hjt
{
namespace
{
/// A swing at a time [s], with the current that the twin of `parameters` predicts for it and `more` [A] of it.
class SwingingRobot
{
public:
  SwingingRobot(const Parameters& parameters, double seconds) : parameters_(parameters)
  {
    Tracker twin(parameters_, InputMode::MOTION);
    twin.pushLoad(0.0, 0.0);
    for (int i = 0; i * PERIOD < seconds; ++i)
    {
      twin.push(rowAt(PERIOD * i));
      takeAll(twin, false, predicted_);
    }
    takeAll(twin, true, predicted_);
  }

  std::size_t rows() const { return predicted_.size(); }
  const Comparison& predicted(std::size_t row) const { return predicted_[row]; }

  void push(Tracker& tracker, std::size_t row, double more) const
  {
    MotionRow measured = rowAt(PERIOD * static_cast<double>(row));
    measured.current = predicted_[row].current.predicted + more;
    tracker.push(measured);
    hjt::takeAll(tracker);
  }

private:
  static void takeAll(Tracker& tracker, bool at_end, std::vector<Comparison>& all)
  {
    const std::vector<Comparison> taken = hjt::takeAll(tracker, at_end);
    all.insert(all.end(), taken.begin(), taken.end());
  }

  Parameters parameters_;
  std::vector<Comparison> predicted_;
};

const std::vector<std::string> KNOWN_LOAD{ "telemetry.load=load_torque", "output.load_inertia=0.5" };

TEST(Tracker, SeesWhatTouchesTheArmAndJudgesAgainAfterwards)
{
  const Parameters parameters = parametersWith(KNOWN_LOAD);
  const SwingingRobot robot(parameters, 60.0);
  Tracker tracker(parameters, InputMode::MOTION);
  tracker.pushLoad(0.0, 0.0);
  std::vector<double> touched;
  for (std::size_t i = 0; i < robot.rows(); ++i)
  {
    const double time = PERIOD * static_cast<double>(i);
    const bool is_pushed = time > 20.0 && time < 20.5;  // midway in a swing
    robot.push(tracker, i, is_pushed ? 3.0 : 0.0);
    if (tracker.evidence().isTouched())
    {
      touched.push_back(time);
    }
  }
  ASSERT_THAT(touched, SizeIs(Gt(10)));
  EXPECT_NEAR(touched.front(), 20.3, 0.2);
  EXPECT_NEAR(touched.back(), 20.5 + ContactWatch::HOLD, 0.5);
  EXPECT_NEAR(tracker.evidence().contact().last().largest, 3.0 * parameters.telemetry.torque_per_current, 5.0);
  EXPECT_LT(tracker.outsideShare(), 0.02);
}

TEST(VerdictWatch, JudgesNothingWhileSomethingTouchesTheArmOrDoesNotFit)
{
  const Parameters parameters = parametersWith(KNOWN_LOAD);
  const SwingingRobot robot(parameters, 60.0);
  Tracker tracker(parameters, InputMode::MOTION);
  tracker.pushLoad(0.0, 0.0);
  VerdictWatch watch(tracker, { {}, true });
  std::vector<Verdict> each_second;
  const auto row_of = [](double time) { return static_cast<std::size_t>(std::lround(time / PERIOD)); };
  for (std::size_t i = 0; i < robot.rows(); ++i)
  {
    robot.push(tracker, i, i > row_of(20.0) && i < row_of(20.5) ? 3.0 : 0.0);
    if (i % row_of(1.0) == 0)
    {
      watch.judge();
      each_second.push_back(watch.now());
      if (i > row_of(19.0))
      {
        EXPECT_EQ(watch.now().isJudged(), !tracker.evidence().isTouched()) << PERIOD * static_cast<double>(i) << " s";
      }
    }
  }
  const Verdict& before = each_second[19];
  EXPECT_EQ(before.level, VerdictLevel::OK);
  EXPECT_EQ(before.reason, Reason::SOUND);
  EXPECT_NEAR(before.friction.factor, 1.0, 0.02);
  EXPECT_NEAR(before[Figure::FRICTION_OF_OWN], 1.0, 0.02);
  const Verdict& touched = each_second[22];
  EXPECT_EQ(touched.level, VerdictLevel::NOT_JUDGED);
  EXPECT_EQ(touched.reason, Reason::CONTACT);
  EXPECT_FALSE(std::isfinite(touched.friction.factor));
  EXPECT_THAT(verdictText(touched), HasSubstr("touched the arm"));
  EXPECT_EQ(each_second.back().reason, Reason::SOUND);

  watch.setMisfit({ Reason::STAMPS, "the stamps are wrong" }, true);
  EXPECT_EQ(watch.now().reason, Reason::STAMPS);
  EXPECT_EQ(verdictText(watch.now()), "Not judged: the stamps are wrong.");
  EXPECT_EQ(watch.confirmed().reason, Reason::SOUND);
}

TEST(VerdictWatch, AHandThatLeadsTheArmReplacesAVerdict)
{
  const Parameters parameters = parametersWith(KNOWN_LOAD);
  const SwingingRobot robot(parameters, 60.0);
  Tracker tracker(parameters, InputMode::MOTION);
  tracker.pushLoad(0.0, 0.0);
  VerdictWatch watch(tracker, { {}, true });
  ArmFriction arm;
  arm.factors = { 1.0 };
  arm.deviations = { UNWITNESSED };
  const auto row_of = [](double time) { return static_cast<std::size_t>(std::lround(time / PERIOD)); };
  for (std::size_t i = 0; i < robot.rows(); ++i)
  {
    robot.push(tracker, i, 0.0);
    if (i == row_of(30.0))
    {
      EXPECT_EQ(watch.confirmed().level, VerdictLevel::OK);
      arm.misfit = { Reason::LESS_THAN_FAULTS, "led by hand" };
    }
    if (i == row_of(36.0))
    {
      EXPECT_EQ(watch.confirmed().level, VerdictLevel::OK) << "not at once";
    }
    if (i % row_of(1.0) == 0)
    {
      watch.judge(arm, 0);
    }
  }
  EXPECT_EQ(watch.confirmed().level, VerdictLevel::NOT_JUDGED);
  EXPECT_EQ(watch.now().reason, Reason::LESS_THAN_FAULTS);
  EXPECT_EQ(verdictText(watch.now()), "Not judged: led by hand.");
}

TEST(Tracker, WhatStaysIsNoContact)
{
  const Parameters parameters = parametersWith(KNOWN_LOAD);
  const SwingingRobot robot(parameters, 200.0);
  Tracker tracker(parameters, InputMode::MOTION);
  tracker.pushLoad(0.0, 0.0);
  for (std::size_t i = 0; i < robot.rows(); ++i)
  {
    robot.push(tracker, i, i > robot.rows() / 5 ? 3.0 : 0.0);
  }
  EXPECT_FALSE(tracker.evidence().isTouched());
  EXPECT_GT(tracker.outsideShare(), 0.5);
}

TEST(JointEvidence, TellsTheLoadsOfTheMotion)
{
  JointEvidence evidence(parametersWith({}), LoadOrigin::RECORDED);
  for (int i = 0; i < 1000; ++i)
  {
    MotionSample sample;
    sample.time = PERIOD * i;
    sample.load = i % 20 == 0 ? 60.0 : i % 3 == 0 ? 12.0 : -8.0;
    evidence.update(sample);
  }
  EXPECT_EQ(evidence.reach().least_load, -8.0);
  EXPECT_EQ(evidence.reach().most_load, 60.0);
  EXPECT_NEAR(evidence.largestLoad(), 60.0, 1.0) << "one row of twenty";
  EXPECT_NEAR(evidence.typicalLoad(), 8.0, 1.0);
}

TEST(VerdictWatch, PredictsAtTheTemperatureThatAllJointsShowUnlessTheyWereSoWhenSound)
{
  const Parameters parameters = parametersWith(KNOWN_LOAD);
  const SwingingRobot robot(parameters, 120.0);
  for (const std::size_t raised : { 1, 3 })
  {
    std::vector<std::unique_ptr<Tracker>> joints;
    std::vector<std::unique_ptr<VerdictWatch>> watches;
    std::vector<VerdictWatch*> watched;
    for (int joint = 0; joint < 3; ++joint)
    {
      joints.push_back(std::make_unique<Tracker>(parameters, InputMode::MOTION));
      joints.back()->pushLoad(0.0, 0.0);
      watches.push_back(std::make_unique<VerdictWatch>(*joints.back(), JointContext()));
      watched.push_back(watches.back().get());
    }
    for (std::size_t i = 0; i < robot.rows(); ++i)
    {
      const double friction = robot.predicted(i).friction_torque / parameters.telemetry.torque_per_current;
      for (std::size_t joint = 0; joint < 3; ++joint)
      {
        robot.push(*joints[joint], i, joint < raised ? 0.4 * friction : 0.0);
      }
    }
    const ArmFriction found = commonFriction(watched, parameters.comparison.repeat_tolerance);
    EXPECT_TRUE(found.is_known);
    watched.front()->predictAt(found);
    watched.front()->predictAt(ArmFriction());  // nothing is known: it stays
    joints.front()->push(rowAt(PERIOD * static_cast<double>(robot.rows())));
    const std::vector<Comparison> last = takeAll(*joints.front(), true);
    ASSERT_THAT(last, SizeIs(Gt(0)));
    EXPECT_FALSE(last.back().temperature_received);
    ASSERT_EQ(found.temperature.has_value(), raised == 3);
    EXPECT_NEAR(found.median, found.temperature ? 1.4 : 1.0, 0.02);
    EXPECT_EQ(last.back().temperature, found.temperature.value_or(parameters.input.temperature));
    EXPECT_LT(found.temperature.value_or(0.0), parameters.input.temperature - 3.0);
    for (std::size_t joint = 0; joint < 3; ++joint)
    {
      JointContext known;
      known.own.friction = joints[joint]->evidence().friction().points();
      watches[joint] = std::make_unique<VerdictWatch>(*joints[joint], known);
      watched[joint] = watches[joint].get();
    }
    const ArmFriction to_own = commonFriction(watched, parameters.comparison.repeat_tolerance);
    EXPECT_EQ(to_own.median, 1.0);
    EXPECT_FALSE(to_own.temperature.has_value());
  }
}

TEST(Tracker, SeesTheMeasuredJointWithTheHealthMonitor)
{
  Tracker tracker(parametersWith({ "indicators.window_turns=20" }), InputMode::MOTION);
  for (int i = 0; i < 2000; ++i)
  {
    MotionRow row = rowAt(PERIOD * i);
    row.position = PERIOD * i * 0.5;
    tracker.push(row);
    takeAll(tracker);
  }
  EXPECT_GT(tracker.signalIndicators().windows, 2u);
  EXPECT_NEAR(tracker.signalIndicators().point.speed, 101.0 * 0.5, 1.0);
}

TEST(DelayEstimate, FindsALagFromUnevenRows)
{
  for (const double lag : { -0.05, 0.0, 0.013, 0.06 })
  {
    DelayEstimate estimate;
    std::mt19937 engine(2);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    std::normal_distribution<double> unit;
    const auto signal = [](double time) { return std::sin(2.1 * time) + 0.4 * std::sin(7.3 * time) + 0.1 * time; };
    for (int i = 0; i < 2000; ++i)
    {
      if (even(engine) < 0.05)
      {
        continue;
      }
      const double time = PERIOD * (i + 0.3 * even(engine));
      estimate.add(time, signal(time), 3.0 * signal(time - lag) + 5.0 + 0.1 * unit(engine));
    }
    ASSERT_TRUE(estimate.lag().has_value()) << lag;
    EXPECT_NEAR(*estimate.lag(), lag, 0.002);
  }
}

TEST(DelayEstimate, TellsNothingOfSignalsThatAreUnlike)
{
  DelayEstimate estimate;
  for (int i = 0; i < 2000; ++i)
  {
    estimate.add(PERIOD * i, std::sin(2.1 * PERIOD * i), std::sin(9.0 * PERIOD * i));
  }
  EXPECT_FALSE(estimate.lag().has_value());
}

TEST(TimeFit, WeighsMotionByItsAge)
{
  constexpr double PIECES = 2000.0;  // TimeFit's MEMORY
  constexpr double HALF = PIECES * TimeFit::PIECE;
  constexpr double LAG = 0.02;
  TimeFit fit;
  for (int i = 0; 0.01 * i < 2.0 * HALF; ++i)
  {
    const double time = 0.01 * i;
    fit.add(time, -5.0 * std::cos(time), 5.0 * std::sin(time - (time < HALF ? 0.0 : LAG)));
  }
  // The first half counts exp(-1) of the second.
  EXPECT_NEAR(fit.lag().value, LAG / (1.0 + std::exp(-1.0)), 0.02 * LAG);
}

TEST(StreamTiming, TellsClocksOffsetAndJitter)
{
  StreamTiming timing;
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  for (int i = 0; i < 1000; ++i)
  {
    if (i % 100 != 50)
    {
      timing.add(0.002 * i, 0.002 * i - 3.0 + 0.004 * even(engine));
    }
  }
  const StreamTimingReport report = timing.report();
  EXPECT_NEAR(report.period, 0.002, 1e-6);
  EXPECT_EQ(report.missing, 10u);
  EXPECT_NEAR(report.longest_gap, 0.004, 1e-9);
  EXPECT_NEAR(report.offset, -3.0, 1e-4);
  EXPECT_NEAR(report.jitter, 0.0038, 3e-4);
}

TEST(StreamTiming, CountsWhatRepeatsGoesBackOrStartsAnew)
{
  StreamTiming timing;
  for (const double time : { 10.0, 10.1, 10.1, 10.05, 10.2 })
  {
    timing.add(time, time);
  }
  EXPECT_EQ(timing.report().rows, 3u);
  EXPECT_EQ(timing.report().repeated, 1u);
  EXPECT_EQ(timing.report().backward, 1u);
  timing.add(10.2 - 1.01 * StreamTiming::RESTART, 0.0);
  EXPECT_EQ(timing.report().rows, 1u);
  EXPECT_EQ(timing.report().backward, 0u);
}
}  // namespace
}  // namespace hjt
