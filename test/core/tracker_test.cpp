// SPDX-License-Identifier: BSD-3-Clause
// The twin beside measured rows: what a stream does to it, which load it reckons with, how it judges time.

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include <gmock/gmock.h>

#include "test/core/complaint.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/allocation_count.hpp"
#include "test/support/seeded_random.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/telemetry_fit.hpp"
#include "tracking/telemetry_rows.hpp"
#include "tracking/tracker.hpp"
#include "tracking/verdict_watch.hpp"

namespace hjt
{
namespace
{
using testing::Gt;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double PERIOD = 0.008;  // [s]

/// A swing and a current that fits it but for an offset.
MotionRow rowAt(double time)
{
  MotionRow row;
  row.time = time;
  row.position = 0.5 * std::sin(1.3 * time);
  row.current = 1.0 + 0.8 * std::cos(1.3 * time);
  row.received = time + 0.003;
  return row;
}

std::vector<Comparison> takeAll(Tracker& tracker, bool at_end = false)
{
  std::vector<Comparison> taken;
  while (const std::optional<Comparison> now = tracker.pop(at_end))
  {
    taken.push_back(*now);
  }
  return taken;
}

/// What comes of rows one by one: of `count` from `start` on, `change` of each before it is taken, with its number.
template <class Change>
std::vector<Comparison> track(Tracker& tracker, double start, int count, const Change& change)
{
  std::vector<Comparison> taken;
  for (int i = 0; i < count; ++i)
  {
    MotionRow row = rowAt(start + PERIOD * i);
    change(i, row);
    tracker.push(row);
    const std::vector<Comparison> now = takeAll(tracker);
    taken.insert(taken.end(), now.begin(), now.end());
  }
  return taken;
}

std::vector<Comparison> track(Tracker& tracker, double start, int count)
{
  return track(tracker, start, count, [](int, MotionRow&) {});
}

Parameters parametersWith(std::vector<std::string> assignments, const std::vector<std::string>& overlays = {})
{
  assignments.insert(assignments.end(), { "motor.viscous_friction=0.0", "solver.rate=2000" });
  return shippedParameters(assignments, overlays);
}

constexpr double NONE = std::numeric_limits<double>::quiet_NaN();

bool isFinite(const Comparison& now)
{
  double sum = now.joint_torque + now.friction_torque + now.load_torque + now.residual_torque + now.temperature;
  for (const Compared& both : { now.position, now.velocity, now.current })
  {
    sum += both.measured + both.predicted + both.band;
  }
  return std::isfinite(sum);
}

using TrackerInMode = testing::TestWithParam<InputMode>;

/// A row of which angle or current is none, once of each kind, with loads and temperatures of the same.
int pushDamaged(Tracker& tracker, double time, const std::function<bool()>& chooses_angle)
{
  const std::vector<double> bad{ NONE, std::numeric_limits<double>::infinity(), -1e300 };
  for (const double value : bad)
  {
    MotionRow row = rowAt(time);
    (chooses_angle() ? row.position : row.current) = value;
    tracker.push(row);
    tracker.pushLoad(value, value);
    tracker.pushTemperature(value, value);
    tracker.pushTemperature(row.time, value);
  }
  return static_cast<int>(bad.size());
}

TEST_P(TrackerInMode, StaysFiniteThroughWhateverComesAndCountsIt)
{
  Tracker tracker(parametersWith({}), GetParam());
  SeededRandom engine(3);
  std::vector<Comparison> taken;
  int damaged = 0;
  for (int i = 0; i < 1500; ++i)
  {
    const MotionRow row = rowAt(PERIOD * i + 0.002 * engine.uniform(0.0, 1.0));
    tracker.push(row);
    tracker.push(row);  // its stamp again
    if (i % 50 == 7)
    {
      damaged += pushDamaged(tracker, PERIOD * i + 0.003, [&] { return engine.uniform(0.0, 1.0) < 0.5; });
    }
    if (i % 500 == 8)
    {
      tracker.push(rowAt(1e300));
      tracker.push(rowAt(-5e9));
      damaged += 2;
    }
    if (i % 50 == 20)
    {
      tracker.push(rowAt(PERIOD * (i - 3)));  // an earlier one
      i += 4;                                 // and some that never come
    }
    if (i == 700)
    {
      i += 100;
    }
    const std::vector<Comparison> now = takeAll(tracker);
    taken.insert(taken.end(), now.begin(), now.end());
  }
  for (const Comparison& now : taken)
  {
    ASSERT_TRUE(isFinite(now)) << now.time;
  }
  const TrackerCounters counters = tracker.counters();
  EXPECT_EQ(counters.compared, taken.size());
  EXPECT_GT(taken.size(), 1000u);
  EXPECT_GE(counters.refused, static_cast<std::uint64_t>(damaged) + 1200);
  EXPECT_EQ(counters.gaps, 1u);
  EXPECT_EQ(counters.restarts, 0u);
}

TEST_P(TrackerInMode, BeginsAnewWhenStampsJumpBack)
{
  Tracker tracker(parametersWith({}), GetParam());
  track(tracker, 100.0, 400);
  const std::vector<Comparison> taken = track(tracker, 0.0, 400);
  EXPECT_THAT(taken, SizeIs(Gt(390u)));
  EXPECT_TRUE(taken.front().after_gap);
  EXPECT_TRUE(isFinite(taken.back()));
  EXPECT_EQ(tracker.counters().restarts, 1u);
}

/// But no restart of its first row nor after a reset.
TEST_P(TrackerInMode, CountsWhatItRefusedBeforeEveryRestart)
{
  Tracker tracker(parametersWith({}), GetParam());
  for (const double start : { -100.0, -200.0 })
  {
    tracker.push(rowAt(start));
    tracker.reset();
  }
  EXPECT_EQ(tracker.counters().restarts, 0u);
  for (int restart = 0; restart < 3; ++restart)
  {
    tracker.push(rowAt(100.0 - 30.0 * restart));
    tracker.push(rowAt(100.0 - 30.0 * restart));
  }
  EXPECT_EQ(tracker.counters().restarts, 2u);
  EXPECT_EQ(tracker.counters().refused, 3u);
}

TEST_P(TrackerInMode, AllocatesNothing)
{
  Tracker tracker(parametersWith({}), GetParam());
  const std::uint64_t before = allocationCount();
  for (int i = 0; i < 300; ++i)
  {
    tracker.pushLoad(PERIOD * i, 3.0);
    tracker.pushTemperature(PERIOD * i, 30.0);
    tracker.push(rowAt(PERIOD * i));
    while (tracker.pop())
    {
    }
  }
  EXPECT_EQ(allocationCount(), before);
}

INSTANTIATE_TEST_SUITE_P(Modes, TrackerInMode,
                         testing::Values(InputMode::TORQUE, InputMode::MOTION, InputMode::OBSERVER));

/// Comparisons of a joint that stands at an angle under a load of 12 N.m.
Comparison standing(const Parameters& parameters, bool received)
{
  Tracker tracker(parameters, InputMode::MOTION);
  const auto stand = [&](int i, MotionRow& row)
  {
    if (received)
    {
      tracker.pushLoad(PERIOD * i, 12.0);
    }
    row.position = 0.5;
  };
  return track(tracker, 0.0, 100, stand).back();
}

TEST(Tracker, TakesTheLoadFromWhereItIsTold)
{
  const double weight = 20.0 * std::sin(0.5);
  const auto with = [](const char* source) {
    return parametersWith({ "output.gravity_torque=20.0", std::string("telemetry.load=") + source });
  };
  EXPECT_NEAR(standing(with("model"), true).load_torque, weight, 1e-6);
  EXPECT_FALSE(standing(with("model"), true).load_provided);
  EXPECT_NEAR(standing(with("load_torque"), true).load_torque, weight + 12.0, 1e-6);
  EXPECT_NEAR(standing(with("target_moment"), true).load_torque, 12.0, 1e-6);
  EXPECT_TRUE(standing(with("target_moment"), true).load_provided);
  EXPECT_NEAR(standing(with("target_moment"), false).load_torque, weight, 1e-6);
}

TEST(Tracker, KeepsLoadAndTemperatureThatComeBeforeTheFirstRowAfterAJumpBack)
{
  Tracker tracker(parametersWith({ "telemetry.load=target_moment" }), InputMode::MOTION);
  track(tracker, 100.0, 100, [&](int /*i*/, const MotionRow& row) { tracker.pushLoad(row.time, 5.0); });
  tracker.pushLoad(100.0 + PERIOD * 100, 7.0);  // for a row that never comes
  tracker.pushLoad(30.0, 3.0);
  tracker.pushTemperature(30.0, 40.0);
  for (const Comparison& now : track(tracker, 30.0, 100))
  {
    ASSERT_TRUE(now.load_provided) << now.time;
    ASSERT_EQ(now.load_torque, 3.0) << now.time;
    ASSERT_TRUE(now.temperature_received) << now.time;
  }
  EXPECT_EQ(tracker.counters().restarts, 1u);
  EXPECT_EQ(tracker.counters().without_load, 0u);
}

TEST(Tracker, ForgetsTheLoadsBeforeAJumpBack)
{
  Tracker tracker(parametersWith({ "telemetry.load=target_moment" }), InputMode::MOTION);
  tracker.pushLoad(20.0, 5.0);
  tracker.push(rowAt(100.0));
  tracker.pushLoad(100.1, 7.0);
  for (const Comparison& now : track(tracker, 30.0, 100))
  {
    ASSERT_FALSE(now.load_provided) << now.time;
  }
}

TEST(Tracker, TakesTheLoadByItsStampHoweverLateItComes)
{
  const Parameters parameters = parametersWith({ "telemetry.load=target_moment" });
  std::vector<double> loads[2];
  for (const int late : { 0, 1 })
  {
    Tracker tracker(parameters, InputMode::MOTION);
    const auto load = [&](int i, const MotionRow& /*row*/)
    {
      const int received = i - 5 * late;  // 40 ms
      if (received >= 0)
      {
        tracker.pushLoad(PERIOD * received, received);
      }
    };
    for (const Comparison& now : track(tracker, 0.0, 200, load))
    {
      loads[late].push_back(now.load_torque);
    }
  }
  EXPECT_EQ(loads[0], loads[1]);
  EXPECT_EQ(loads[0].back(), static_cast<double>(loads[0].size() - 1));
}

TEST(Tracker, FollowsTheReceivedTemperatureUntilItIsOld)
{
  const Parameters parameters = parametersWith({ "input.temperature=25" });
  for (const InputMode mode : { InputMode::MOTION, InputMode::OBSERVER })
  {
    Tracker tracker(parameters, mode);
    Tracker plain(parameters, mode);
    const auto friction = [](Tracker& of, double time)
    { return track(of, time, 60, [](int i, MotionRow& row) { row.position = 0.9 * PERIOD * i; }).back(); };
    const double at_25 = friction(plain, 0.0).friction_torque;
    EXPECT_FALSE(friction(tracker, 0.0).temperature_received);

    tracker.pushTemperature(1.0, 40.0);
    for (const double bad : { NONE, -21.0, 120.5, std::numeric_limits<double>::infinity() })
    {
      tracker.pushTemperature(1.5, bad);
    }
    EXPECT_EQ(tracker.counters().refused_temperatures, 4u);
    const Comparison warm = friction(tracker, 2.0);
    EXPECT_TRUE(warm.temperature_received);
    EXPECT_EQ(warm.temperature, 40.0);
    EXPECT_LT(warm.friction_torque, 0.9 * at_25);

    const Comparison old = friction(tracker, 1.1 + TemperatureRecord::MAX_AGE);
    EXPECT_FALSE(old.temperature_received);
    EXPECT_EQ(old.temperature, 25.0);
    EXPECT_NEAR(old.friction_torque, at_25, 0.01 * at_25);
  }
}

TEST(Tracker, ARowsOwnTemperatureComesFirst)
{
  Tracker tracker(parametersWith({}), InputMode::MOTION);
  tracker.pushTemperature(0.0, 40.0);
  for (int i = 0; i < 50; ++i)
  {
    MotionRow row = rowAt(PERIOD * i);
    row.temperature = i < 20 ? NONE : 12.0;
    tracker.push(row);
  }
  const std::vector<Comparison> taken = takeAll(tracker, true);
  EXPECT_EQ(taken[19].temperature, 40.0);
  EXPECT_EQ(taken[20].temperature, 12.0);
}

TEST(Tracker, RefusesAWeightThatTheLoadHoldsAlready)
{
  const Parameters parameters = parametersWith({ "output.gravity_torque=20.0", "telemetry.load=target_moment" });
  for (const InputMode mode : { InputMode::TORQUE, InputMode::OBSERVER })
  {
    EXPECT_THAT(complaintOf([&] { Tracker(parameters, mode); }), HasSubstr("output.gravity_torque"));
  }
}

TEST(Tracker, TellsHowManyOfTheLastRowsDepart)
{
  const auto share_with = [](double offset, int rows)
  {
    Tracker tracker(parametersWith({ "output.load_inertia=0.02" }), InputMode::MOTION);
    track(tracker, 0.0, rows,
          [&](int i, MotionRow& row)
          {
            row.position = 0.5 * PERIOD * i;
            row.current = offset;
          });
    return tracker.outsideShare();
  };
  const int seconds = static_cast<int>(std::lround(1.0 / PERIOD));
  const double memory = Tracker::OUTSIDE_MEMORY;
  EXPECT_LT(share_with(0.8, static_cast<int>(memory) * seconds), 0.05);
  EXPECT_NEAR(share_with(5.0, static_cast<int>(memory) * seconds), 1.0 - std::exp(-1.0), 0.02);
  EXPECT_NEAR(share_with(5.0, 2 * seconds), 1.0 - std::exp(-2.0 / memory), 0.01);
}

/// A swing at a time [s], with the current that the twin of `parameters` predicts for it and `more` [A] of it.
class SwingingRobot
{
public:
  SwingingRobot(const Parameters& parameters, double seconds) : parameters_(parameters)
  {
    Tracker twin(parameters_, InputMode::MOTION);
    twin.pushLoad(0.0, 0.0);
    predicted_ = track(twin, 0.0, static_cast<int>(std::ceil(seconds / PERIOD)));
    const std::vector<Comparison> last = takeAll(twin, true);
    predicted_.insert(predicted_.end(), last.begin(), last.end());
  }

  std::size_t rows() const { return predicted_.size(); }
  const Comparison& predicted(std::size_t row) const { return predicted_[row]; }

  void push(Tracker& tracker, std::size_t row, double more) const
  {
    MotionRow measured = rowAt(PERIOD * static_cast<double>(row));
    measured.current = predicted_[row].current.predicted + more;
    tracker.push(measured);
    takeAll(tracker);
  }

private:
  Parameters parameters_;
  std::vector<Comparison> predicted_;
};

const std::vector<std::string> KNOWN_LOAD{ "telemetry.load=load_torque", "output.load_inertia=0.5" };

/// A robot that swings for so many seconds, and its twin beside it.
struct TrackedRobot
{
  explicit TrackedRobot(double seconds) : robot(parameters, seconds) { tracker.pushLoad(0.0, 0.0); }

  Parameters parameters = parametersWith(KNOWN_LOAD);
  SwingingRobot robot;
  Tracker tracker{ parameters, InputMode::MOTION };
};

std::size_t rowOf(double time)
{
  return static_cast<std::size_t>(std::lround(time / PERIOD));
}

TEST(Tracker, SeesWhatTouchesTheArmAndJudgesAgainAfterwards)
{
  TrackedRobot tracked(60.0);
  auto& [parameters, robot, tracker] = tracked;
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
  TrackedRobot tracked(60.0);
  auto& [parameters, robot, tracker] = tracked;
  VerdictWatch watch(tracker, { {}, true });
  std::vector<Verdict> each_second;
  for (std::size_t i = 0; i < robot.rows(); ++i)
  {
    robot.push(tracker, i, i > rowOf(20.0) && i < rowOf(20.5) ? 3.0 : 0.0);
    if (i % rowOf(1.0) == 0)
    {
      watch.judge();
      each_second.push_back(watch.now());
      if (i > rowOf(19.0))
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
  EXPECT_FALSE(std::isfinite(before[Figure::CONTACT_SINCE]));
  const Verdict& touched = each_second[22];
  EXPECT_EQ(touched.level, VerdictLevel::NOT_JUDGED);
  EXPECT_EQ(touched.reason, Reason::CONTACT);
  EXPECT_NEAR(touched[Figure::CONTACT_SINCE], 20.0, 0.1);
  EXPECT_NEAR(touched[Figure::LARGEST_CONTACT_TORQUE], 3.0 * parameters.telemetry.torque_per_current, 5.0);
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
  TrackedRobot tracked(60.0);
  auto& [parameters, robot, tracker] = tracked;
  VerdictWatch watch(tracker, { {}, true });
  ArmFriction arm;
  arm.factors = { 1.0 };
  arm.deviations = { UNWITNESSED };
  for (std::size_t i = 0; i < robot.rows(); ++i)
  {
    robot.push(tracker, i, 0.0);
    if (i == rowOf(30.0))
    {
      EXPECT_EQ(watch.confirmed().level, VerdictLevel::OK);
      arm.misfit = { Reason::LESS_THAN_FAULTS, "led by hand" };
    }
    if (i == rowOf(36.0))
    {
      EXPECT_EQ(watch.confirmed().level, VerdictLevel::OK) << "not at once";
    }
    if (i % rowOf(1.0) == 0)
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
  TrackedRobot tracked(200.0);
  auto& [parameters, robot, tracker] = tracked;
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
  track(tracker, 0.0, 2000, [](int i, MotionRow& row) { row.position = PERIOD * i * 0.5; });
  EXPECT_GT(tracker.signalIndicators().windows, 2u);
  EXPECT_NEAR(tracker.signalIndicators().point.speed, 101.0 * 0.5, 1.0);
}

TEST(DelayEstimate, FindsALagFromUnevenRows)
{
  for (const double lag : { -0.05, 0.0, 0.013, 0.06 })
  {
    DelayEstimate estimate;
    SeededRandom engine(2);
    const auto signal = [](double time) { return std::sin(2.1 * time) + 0.4 * std::sin(7.3 * time) + 0.1 * time; };
    for (int i = 0; i < 2000; ++i)
    {
      if (engine.uniform(0.0, 1.0) < 0.05)
      {
        continue;
      }
      const double time = PERIOD * (i + 0.3 * engine.uniform(0.0, 1.0));
      estimate.add(time, signal(time), 3.0 * signal(time - lag) + 5.0 + 0.1 * engine.normal());
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
  SeededRandom engine(2);
  for (int i = 0; i < 1000; ++i)
  {
    if (i % 100 != 50)
    {
      timing.add(0.002 * i, 0.002 * i - 3.0 + 0.004 * engine.uniform(0.0, 1.0));
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
