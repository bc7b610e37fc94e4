// SPDX-License-Identifier: BSD-3-Clause
// The twin beside measured rows: what a stream does to it, which load it reckons with, how it judges time.
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "test/core/complaint.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"

#include "test/core/tracker_support.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/tracker.hpp"
#include "tracking/verdict_watch.hpp"

namespace hjt
{
namespace
{
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

class TrackerInMode : public testing::TestWithParam<InputMode>
{
};

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
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::vector<Comparison> taken;
  const auto keep = [&]
  {
    for (const Comparison& now : takeAll(tracker))
    {
      taken.push_back(now);
    }
  };
  int damaged = 0;
  for (int i = 0; i < 1500; ++i)
  {
    const MotionRow row = rowAt(PERIOD * i + 0.002 * even(engine));
    tracker.push(row);
    tracker.push(row);  // its stamp again
    if (i % 50 == 7)
    {
      damaged += pushDamaged(tracker, PERIOD * i + 0.003, [&] { return even(engine) < 0.5; });
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
    keep();
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
  for (int i = 0; i < 400; ++i)
  {
    tracker.push(rowAt(100.0 + PERIOD * i));
    takeAll(tracker);
  }
  for (int i = 0; i < 400; ++i)
  {
    tracker.push(rowAt(PERIOD * i));
  }
  const std::vector<Comparison> taken = takeAll(tracker);
  EXPECT_THAT(taken, SizeIs(Gt(390u)));
  EXPECT_TRUE(taken.front().after_gap);
  EXPECT_TRUE(isFinite(taken.back()));
  EXPECT_EQ(tracker.counters().restarts, 1u);
}

TEST_P(TrackerInMode, CountsWhatItRefusedBeforeEveryRestart)
{
  Tracker tracker(parametersWith({}), GetParam());
  for (int restart = 0; restart < 3; ++restart)
  {
    tracker.push(rowAt(100.0 - 30.0 * restart));
    tracker.push(rowAt(100.0 - 30.0 * restart));
  }
  EXPECT_EQ(tracker.counters().restarts, 2u);
  EXPECT_EQ(tracker.counters().refused, 3u);
}

TEST_P(TrackerInMode, CountsNoRestartOfItsFirstRowNorAfterAReset)
{
  Tracker tracker(parametersWith({}), GetParam());
  for (const double start : { -100.0, -200.0 })
  {
    tracker.push(rowAt(start));
    tracker.reset();
  }
  EXPECT_EQ(tracker.counters().restarts, 0u);
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
  Comparison last;
  for (int i = 0; i < 100; ++i)
  {
    if (received)
    {
      tracker.pushLoad(PERIOD * i, 12.0);
    }
    MotionRow row = rowAt(PERIOD * i);
    row.position = 0.5;
    tracker.push(row);
    for (const Comparison& now : takeAll(tracker))
    {
      last = now;
    }
  }
  return last;
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
  for (int i = 0; i < 100; ++i)
  {
    tracker.pushLoad(100.0 + PERIOD * i, 5.0);
    tracker.push(rowAt(100.0 + PERIOD * i));
    takeAll(tracker);
  }
  tracker.pushLoad(100.0 + PERIOD * 100, 7.0);  // for a row that never comes
  tracker.pushLoad(30.0, 3.0);
  tracker.pushTemperature(30.0, 40.0);
  for (int i = 0; i < 100; ++i)
  {
    tracker.push(rowAt(30.0 + PERIOD * i));
  }
  for (const Comparison& now : takeAll(tracker))
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
  for (int i = 0; i < 100; ++i)
  {
    tracker.push(rowAt(30.0 + PERIOD * i));
  }
  for (const Comparison& now : takeAll(tracker))
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
    for (int i = 0; i < 200; ++i)
    {
      const int received = i - 5 * late;  // 40 ms
      if (received >= 0)
      {
        tracker.pushLoad(PERIOD * received, received);
      }
      tracker.push(rowAt(PERIOD * i));
      for (const Comparison& now : takeAll(tracker))
      {
        loads[late].push_back(now.load_torque);
      }
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
    {
      std::vector<Comparison> taken;
      for (int i = 0; i < 60; ++i)
      {
        MotionRow row = rowAt(time + PERIOD * i);
        row.position = 0.9 * PERIOD * i;
        of.push(row);
        for (const Comparison& now : takeAll(of))
        {
          taken.push_back(now);
        }
      }
      return taken.back();
    };
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
    for (int i = 0; i < rows; ++i)
    {
      MotionRow row = rowAt(PERIOD * i);
      row.position = 0.5 * PERIOD * i;
      row.current = offset;
      tracker.push(row);
      takeAll(tracker);
    }
    return tracker.outsideShare();
  };
  const int seconds = static_cast<int>(std::lround(1.0 / PERIOD));
  const double memory = Tracker::OUTSIDE_MEMORY;
  EXPECT_LT(share_with(0.8, static_cast<int>(memory) * seconds), 0.05);
  EXPECT_NEAR(share_with(5.0, static_cast<int>(memory) * seconds), 1.0 - std::exp(-1.0), 0.02);
  EXPECT_NEAR(share_with(5.0, 2 * seconds), 1.0 - std::exp(-2.0 / memory), 0.01);
}
}  // namespace
}  // namespace hjt
