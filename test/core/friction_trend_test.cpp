// SPDX-License-Identifier: BSD-3-Clause
// A line through the friction of many recordings: what it finds, and how often it is wrong.
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <gmock/gmock.h>

#include "test/support/seeded_random.hpp"
#include "tracking/friction_trend.hpp"

namespace hjt
{
namespace
{
constexpr double MONTHS = 4000.0;  // [h]

/// `count` recordings at equal distances over MONTHS: factors exp(slope * time) times what `error` gives.
template <class Error>
std::vector<DatedFriction> recordings(int count, double slope, double deviation, const Error& error)
{
  std::vector<DatedFriction> all;
  for (int i = 0; i < count; ++i)
  {
    const double time = MONTHS * i / (count - 1);
    all.push_back({ time, std::exp(slope * time + error()), deviation, 0.0, 0.0 });
  }
  return all;
}

double none()
{
  return 0.0;
}

TEST(FrictionTrend, OfFactorsOnALineIsThatLine)
{
  std::vector<DatedFriction> line = recordings(7, 1e-4, 0.04, none);
  line[2].deviation = 0.2;
  const FrictionTrend trend = frictionTrend(line);
  EXPECT_NEAR(trend.slope, 1e-4, 1e-12);
  EXPECT_NEAR(trend.change(), std::exp(0.4), 1e-9);
  EXPECT_EQ(trend.recordings, 7U);
  EXPECT_EQ(trend.span, MONTHS);
  EXPECT_TRUE(trend.departs());
}

TEST(FrictionTrend, WithoutACommonFactorItsIntervalIsThatOfARegression)
{
  constexpr int COUNT = 8;
  constexpr double SCATTER = 0.1;
  int row = 0;
  const auto error = [&row] { return (row++ / 2) % 2 == 0 ? SCATTER : -SCATTER; };
  const std::vector<DatedFriction> scattered = recordings(COUNT, 0.0, 0.05, error);
  double times = 0.0;
  double along = 0.0;
  double squares = 0.0;
  for (const DatedFriction& one : scattered)
  {
    times += std::pow(one.time - 0.5 * MONTHS, 2);
    along += (one.time - 0.5 * MONTHS) * std::log(one.factor);
    squares += std::pow(std::log(one.factor), 2);
  }
  const FrictionTrend trend = frictionTrend(scattered);
  EXPECT_NEAR(trend.slope, along / times, 1e-15);
  EXPECT_NEAR(trend.deviation / std::sqrt((squares - along * along / times) / (COUNT - 2) / times), 1.0, 1e-9);
}

TEST(FrictionTrend, IsNotKnownOfTooFewRecordingsOrOfOneTime)
{
  EXPECT_FALSE(frictionTrend({}).isKnown());
  EXPECT_FALSE(frictionTrend(recordings(3, 1e-4, 0.01, none)).isKnown());
  EXPECT_FALSE(frictionTrend(recordings(3, 1e-4, 0.01, none)).departs());
  EXPECT_TRUE(frictionTrend(recordings(4, 1e-4, 0.01, none)).isKnown());
  EXPECT_FALSE(frictionTrend(std::vector<DatedFriction>(9, { 5.0, 1.0, 0.01, 0.0, 0.0 })).isKnown());
}

TEST(FrictionTrend, HasTheTruthInItsIntervalAsOftenAsItSays)
{
  constexpr int TRIALS = 4000;
  constexpr double SLOPE = 2e-5;
  SeededRandom engine(7);
  int inside = 0;
  for (int i = 0; i < TRIALS; ++i)
  {
    const FrictionTrend trend = frictionTrend(recordings(12, SLOPE, 0.05, [&] { return 0.05 * engine.normal(); }));
    inside += trend.slopeLow() <= SLOPE && SLOPE <= trend.slopeHigh() ? 1 : 0;
  }
  // 95 %, and something more, since a scatter above the stated one widens the interval.
  const double share = static_cast<double>(inside) / TRIALS;
  EXPECT_GT(share, 0.95);
  EXPECT_LT(share, 0.98);
}

TEST(FrictionTrend, OfASoundJointThatScattersMoreThanStatedIsRarelyNamed)
{
  constexpr int TRIALS = 4000;
  SeededRandom engine(8);
  for (const double scatter : { 0.05, 0.1 })
  {
    for (const int count : { 4, 10, 40 })
    {
      int named = 0;
      for (int i = 0; i < TRIALS; ++i)
      {
        named +=
            frictionTrend(recordings(count, 0.0, 0.05, [&] { return scatter * engine.normal(); })).departs() ? 1 : 0;
      }
      // Where the deviations are right less than the 5 % outside of an interval.
      EXPECT_LT(named, (scatter > 0.05 ? 0.1 : 0.03) * TRIALS) << scatter << ", " << count << " recordings";
    }
  }
}

TEST(FrictionTrend, BelowWhatCountsAsAChangeIsNotNamedHoweverCertain)
{
  const auto over = [](double change) { return std::log(change) / MONTHS; };
  EXPECT_FALSE(frictionTrend(recordings(400, over(1.045), 0.01, none)).departs());
  EXPECT_TRUE(frictionTrend(recordings(400, over(1.06), 0.01, none)).departs());
  EXPECT_FALSE(frictionTrend(recordings(400, over(0.91), 0.01, none)).departs());
  EXPECT_TRUE(frictionTrend(recordings(400, over(0.89), 0.01, none)).departs());
}

TEST(FrictionTrend, OfTheSeasonsDoesNotAverageOut)
{
  constexpr double SLOW = 0.06;
  const double slope = std::log(1.3) / MONTHS;
  std::vector<DatedFriction> many = recordings(400, slope, 0.07, none);
  EXPECT_TRUE(frictionTrend(many).departs());
  for (DatedFriction& recording : many)
  {
    recording.slow_deviation = SLOW;
  }
  EXPECT_FALSE(frictionTrend(many).departs());
  // A line through a step in the middle rises by three times its half.
  EXPECT_NEAR(frictionTrend(many).deviation * MONTHS, 3.0 * SLOW, 0.003);
  std::vector<DatedFriction> steps = recordings(400, 0.0, 0.07, none);
  for (DatedFriction& recording : steps)
  {
    recording.factor = std::exp(recording.time < 0.5 * MONTHS ? -SLOW : SLOW);
  }
  EXPECT_NEAR(frictionTrend(steps).slope * MONTHS, 3.0 * SLOW, 0.003);
}

TEST(FrictionTrend, OfAJointThatAnswersTheTemperatureByLessThanTheOthersIsNone)
{
  const auto warming = [](double common_end)
  {
    std::vector<DatedFriction> all = recordings(12, 0.0, 0.03, none);
    for (DatedFriction& recording : all)
    {
      recording.common = common_end * recording.time / MONTHS;
      recording.factor = std::exp(-0.5 * recording.common);  // half of what the others do
    }
    return all;
  };
  EXPECT_FALSE(frictionTrend(warming(-0.3)).departs());
  EXPECT_FALSE(frictionTrend(warming(0.3)).departs());
  // Over whole seasons the answer is known, and a trend beside it is found.
  std::vector<DatedFriction> seasons = recordings(25, std::log(1.25) / MONTHS, 0.03, none);
  for (std::size_t i = 0; i < seasons.size(); ++i)
  {
    seasons[i].common = 0.1 * std::cos(0.7 * static_cast<double>(i));
    seasons[i].factor *= std::exp(-0.5 * seasons[i].common);
  }
  EXPECT_TRUE(frictionTrend(seasons).departs());
  EXPECT_NEAR(frictionTrend(seasons).change(), 1.25, 0.005);
}

TEST(FrictionTrend, WhatJointsHaveInCommonIsTheMedianOfTheirChanges)
{
  using Row = std::vector<std::optional<double>>;
  const Row low{ 0.0, 0.1, 0.2, 0.3, 0.1 };
  Row high = low;
  Row failing = low;
  for (std::size_t i = 0; i < low.size(); ++i)
  {
    *high[i] += 0.4;
    *failing[i] += i < 3 ? 0.0 : 0.5;
  }
  const Row common = commonOfRecordings({ low, high, failing });
  for (std::size_t i = 0; i < low.size(); ++i)
  {
    ASSERT_TRUE(common[i]);
    EXPECT_NEAR(*common[i], *low[i] - 0.1, 1e-12);
  }
  high[2].reset();
  EXPECT_FALSE(commonOfRecordings({ low, high, failing })[2]);
  EXPECT_FALSE(commonOfRecordings({ low, low })[0]);
}
}  // namespace
}  // namespace hjt
