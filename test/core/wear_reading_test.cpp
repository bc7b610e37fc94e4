// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "life/read_wear.hpp"
#include "life/wear_trend.hpp"
#include "test/core/life_support.hpp"

namespace hjt
{
namespace
{
constexpr ReadingErrors GOOD_READINGS{ 0.05, 0.02, 0.005, 0.02 };

TEST(WearTrend, FindsTheRateOfAStraightLineWithAnOffset)
{
  std::vector<WearPoint> points;
  for (int i = 1; i <= 8; ++i)
  {
    points.push_back({ 0.1 * i, 0.05 * i - 0.02 });  // half the nominal wear
  }
  const WearTrend trend(points, GOOD_READINGS, 0.0);
  ASSERT_TRUE(trend.isKnown());
  double best = 0.0;
  for (double factor = 0.3; factor < 0.7; factor += 0.001)
  {
    best = trend.logDensity(factor) > trend.logDensity(best) ? factor : best;
  }
  EXPECT_NEAR(best, 0.5, 0.015);  // the offset is held to be near 0
  // The readings go on as they did, whatever the drive's own factor is.
  EXPECT_NEAR(trend.nominalAt(0.58, best, 0.0, 0.0), 1.2, 0.01);
}

TEST(WearTrend, KnowsLessOfARateThatMayHaveChanged)
{
  constexpr ReadingErrors EXACT_GAIN{ 0.01, 0.02, 0.005, 0.02 };
  const std::vector<WearPoint> points{ { 0.1, 0.1 }, { 0.2, 0.2 }, { 0.3, 0.3 }, { 0.4, 0.4 } };
  const WearTrend steady(points, EXACT_GAIN, 0.0);
  const WearTrend changing(points, EXACT_GAIN, 0.5);
  // How much less likely a factor is that lies a third above the best one.
  const auto sharpness = [](const WearTrend& trend)
  {
    double best = 0.1;
    for (double factor = 0.1; factor < 4.0; factor += 0.01)
    {
      best = trend.logDensity(factor) > trend.logDensity(best) ? factor : best;
    }
    return trend.logDensity(best) - trend.logDensity(4.0 / 3.0 * best);
  };
  EXPECT_GT(sharpness(steady), 1.5 * sharpness(changing));
  EXPECT_FALSE(WearTrend().isKnown());
  EXPECT_FALSE(WearTrend({}, GOOD_READINGS, 0.0).isKnown());
  EXPECT_FALSE(WearTrend({ { 0.0, 0.0 } }, GOOD_READINGS, 0.0).isKnown()) << "no use, no rate";
}

TEST(LoadFeedback, IsTheIntegralOfTheRatesInverse)
{
  const LoadFeedback none(2.0, [](double) { return 1.0; });
  for (const double depth : { -0.5, 0.0, 0.3, 2.0, 5.0 })
  {
    EXPECT_NEAR(none.of(depth), depth, 1e-12);
  }
  const LoadFeedback faster(1.0, [](double depth) { return 1.0 + depth; });
  EXPECT_NEAR(faster.of(1.0), std::log(2.0), 1e-3);  // trapezoids on eight stretches
}

TEST(RemainingLife, FollowsReadingsOfWearToTheLimitOfDepthAndOfLostMotion)
{
  FlankUse use;
  use.parameters.life.wear_spread = 2.3;
  const double depth = use.parameters.fault_scale.tooth_wear_depth;
  const double factor = 3.0;  // of the drive's wear
  const double hours = 200.0;
  std::vector<WearPoint> points;
  for (int i = 1; i <= 4; ++i)
  {
    const double nominal = 0.25 * i * hours * use.hourly / depth;
    points.push_back({ nominal, factor * nominal });
  }
  WearTrends trends;
  trends.flank = { points, GOOD_READINGS, 0.0 };
  RemainingLife drives(use.parameters);
  const RemainingHours read = drives.remaining(use.until(hours), use.ahead, nullptr, {}, trends);
  const double end = use.parameters.life.flank_wear_limit / use.hourly / factor;
  EXPECT_NEAR(read.quantile[2], end - hours, 0.1 * (end - hours));
  EXPECT_LT(width(read), 2.56 * (RATE_SCATTER * std::sqrt(2.0) + 0.15) * end);
  EXPECT_LT(width(read), 0.3 * width(drives.remaining(use.until(hours), use.ahead, nullptr, {})));
  trends.flank_depth = depth;
  trends.reading_at_end = 0.8 * use.parameters.life.flank_wear_limit / depth;
  const RemainingHours by_play = drives.remaining(use.until(hours), use.ahead, nullptr, {}, trends);
  EXPECT_NEAR(by_play.quantile[2], 0.8 * end - hours, 0.1 * (0.8 * end - hours));
  EXPECT_TRUE(std::is_sorted(by_play.quantile.begin(), by_play.quantile.end()));
}

TEST(RemainingLife, KeepsTheRateOfWearToTheEndOfTheFillingOfGrease)
{
  FlankUse use;
  use.parameters.life.wear_spread = 2.3;
  const double hours = 0.5 * use.parameters.life.flank_wear_limit / use.hourly;  // half of the life
  const double nominal = hours * use.hourly / use.parameters.fault_scale.tooth_wear_depth;
  WearTrends trends;
  trends.flank = { { { nominal, nominal } }, ReadingErrors{ 0.01, 0.001, 0.001, 0.01 }, 0.0 };
  RemainingLife drives(use.parameters);
  const auto width_after = [&](double fillings)
  {
    Usage so_far = use.until(hours);
    so_far.fillings = fillings;
    return width(drives.remaining(so_far, use.ahead, nullptr, {}, trends));
  };
  EXPECT_LT(width_after(0.4), 0.1 * hours) << "the readings' errors alone: 2.56 times 2 % of the whole life";
  // One filling behind, another ahead: they differ by the scatter of both.
  EXPECT_NEAR(width_after(1.0), 2.56 * RATE_SCATTER * std::sqrt(2.0) * hours, 0.15 * hours);
  EXPECT_LT(width_after(9.0), 0.5 * width_after(1.0)) << "many fillings on either side";
}

/// Signatures of a gear whose lost motion, K1 and K2 wear moves evenly.
SignatureSet evenSignatures()
{
  SignatureSet set;
  const auto add = [&](FaultKind kind, double play, double first, double second)
  {
    for (const double severity : { 0.1, 0.5, 1.0 })
    {
      Signature signature{ causeOf(kind), severity, ANY_MOTION, {} };
      signature.change[indexOf(ScalarIndicator::LOST_MOTION)] = play * severity;
      signature.change[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)] = first * severity;
      signature.change[indexOf(ScalarIndicator::SECOND_STIFFNESS)] = second * severity;
      set.signatures.push_back(signature);
    }
  };
  add(FaultKind::TOOTH_WEAR, 10.0, -0.2, 0.02);
  add(FaultKind::INTERFACE_WEAR, 0.0, -0.2, -0.1);
  return set;
}

TEST(WearReading, IsTheSeveritiesThatMakeTheDifferences)
{
  SignatureSet set = evenSignatures();
  constexpr double PLAY = 2e-4;
  constexpr double STIFFNESS = 3e4;
  for (const auto& [flank, interface] : { std::pair{ 0.0, 0.0 }, { 0.3, 0.7 }, { 1.3, 0.05 } })
  {
    WindowResidual residual;
    const auto put = [&](ScalarIndicator indicator, double sound, double share)
    {
      residual.sound[indexOf(indicator)] = sound;
      residual.difference[indexOf(indicator)] = share * sound;
      residual.own[indexOf(indicator)] = 1e-6 * sound * sound;
    };
    put(ScalarIndicator::LOST_MOTION, PLAY, 10.0 * flank);
    put(ScalarIndicator::TORSIONAL_STIFFNESS, STIFFNESS, -0.2 * flank - 0.2 * interface);
    put(ScalarIndicator::SECOND_STIFFNESS, STIFFNESS, 0.02 * flank - 0.1 * interface);
    const WearReading reading = readWear(residual, {}, set);
    ASSERT_TRUE(reading.is_read);
    EXPECT_NEAR(reading.flank, flank, 1e-9);
    EXPECT_NEAR(reading.interface, interface, 1e-9);
    EXPECT_NEAR(reading.lost_motion, PLAY * (1.0 + 10.0 * flank), 1e-12);
    EXPECT_NEAR(reading.lost_motion_slope, 10.0 * PLAY, 1e-12);
    std::reverse(set.signatures.begin(), set.signatures.end());
    EXPECT_NEAR(readWear(residual, {}, set).interface, interface, 1e-9) << "in any order";
    EXPECT_NEAR(readWear(residual, {}, set).lost_motion_slope, 10.0 * PLAY, 1e-12);
    residual.own[indexOf(ScalarIndicator::LOST_MOTION)] = 0.0;  // the load went one way
    EXPECT_FALSE(readWear(residual, {}, set).is_read);
    EXPECT_FALSE(readWear(residual, {}, SignatureSet()).is_read);
  }
}

TEST(WearReading, GoesByTheSpeedAndNotByHowFarAMotionGoesOneWay)
{
  SignatureSet set = evenSignatures();
  for (Signature& signature : set.signatures)
  {
    signature.motion = { 80.0, 0.0 };
  }
  const std::size_t even = set.signatures.size();
  for (std::size_t i = 0; i < even; ++i)
  {
    set.signatures.push_back(set.signatures[i]);
    set.signatures.back().motion = { 160.0, 1.0 };
    set.signatures.back().change[indexOf(ScalarIndicator::LOST_MOTION)] *= 0.5;
  }
  WindowResidual residual;
  for (const auto& [indicator, sound, share] : { std::tuple{ ScalarIndicator::LOST_MOTION, 2e-4, 3.0 },
                                                 { ScalarIndicator::TORSIONAL_STIFFNESS, 3e4, -0.1 },
                                                 { ScalarIndicator::SECOND_STIFFNESS, 5e4, -0.1 } })
  {
    residual.sound[indexOf(indicator)] = sound;
    residual.difference[indexOf(indicator)] = share * sound;
    residual.own[indexOf(indicator)] = 1e-6 * sound * sound;
  }
  OperatingPoint one_way;
  one_way.speed = 80.0;
  one_way.direction = 1.0;
  const WearReading like = readWear(residual, one_way, set);
  EXPECT_NEAR(like.flank, 0.3, 0.002);
  EXPECT_NEAR(like.alike, 1.0, 1e-12);
  OperatingPoint slow;
  slow.speed = 30.0;
  EXPECT_LT(readWear(residual, slow, set).alike, 0.01);
}

TEST(RemainingLife, AlarmOfWearThatWasReadIsNoEvidenceOfASpall)
{
  const Usage so_far{ 0.0, 0.0, 0.0, 1e9 };
  const FutureLoad ahead{ 1000.0, { {}, { 0.0, 0.0, 0.0, 1e7 } } };
  WearTrends trends;
  trends.flank = { { { 0.1, 0.1 } }, GOOD_READINGS, 0.0 };
  trends.interface = trends.flank;
  Assessment worn;
  worn.state = AssessmentState::ASSESSED;
  worn.level = HealthLevel::WARN;
  worn.cause = causeOf(FaultKind::TOOTH_WEAR);
  worn.confidence = 0.7;
  worn.severity = 0.5;
  worn.severity_deviation = 0.05;
  worn.alternative_count = 1;
  worn.alternatives[0] = { causeOf(FaultKind::BEARING_OUTER_RACE), 0.3, 0.5, 0.05 };
  RemainingLife drives(shippedParameters());
  // A drive with a spall is at its end soon.
  const auto soon = [&](const Assessment* assessment)
  {
    const RemainingHours remaining = drives.remaining(so_far, ahead, assessment, {}, trends);
    double share = 0.0;
    for (std::size_t bin = 0; RemainingHours::edge(bin) < 5e3; ++bin)
    {
      share += remaining.probability[bin];
    }
    return share;
  };
  EXPECT_GT(soon(&worn), soon(nullptr));
  EXPECT_LT(soon(&worn), 2.5 * soon(nullptr)) << "0.3 of a density of about 1.2 beside 0.7";
}

TEST(UnitVariation, DiffersFromFillingToFillingAsOftenUpAsDown)
{
  UnitVariation variation;
  EXPECT_EQ(fillingFactor(variation, 3), 1.0) << "the nominal drive does not";
  variation.fillings = 77;
  double sum = 0.0;
  double squares = 0.0;
  constexpr int COUNT = 2000;
  for (std::uint32_t i = 0; i < COUNT; ++i)
  {
    const double logarithm = std::log(fillingFactor(variation, i));
    sum += logarithm;
    squares += logarithm * logarithm;
  }
  EXPECT_NEAR(sum / COUNT, 0.0, 4.0 * RATE_SCATTER / std::sqrt(COUNT));
  EXPECT_NEAR(std::sqrt(squares / COUNT), RATE_SCATTER, 4.0 * RATE_SCATTER / std::sqrt(2.0 * COUNT));
}
}  // namespace
}  // namespace hjt
