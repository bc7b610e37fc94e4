// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "life/read_wear.hpp"
#include "life/wear_trend.hpp"
#include "test/core/life_support.hpp"

namespace hjt
{
namespace
{
TEST(RemainingLife, WithoutAssessmentIsThePriorOfTheCatalogue)
{
  Parameters parameters = shippedParameters();
  LifeParameters& life = parameters.life;
  life.wear_spread = 0.0;
  life.spall_spread = 0.0;
  const double turns_per_hour = life.rated_speed * 3600.0 / TWO_PI;
  FutureLoad rated{ 1000.0, {} };
  for (int i = 0; i < 400; ++i)
  {
    rated.usage.push_back({ 0.0, 0.0, 0.0, 1000.0 * i * turns_per_hour });
  }
  RemainingLife drives(parameters);
  const RemainingHours fresh = drives.remaining({}, rated, nullptr, {});
  EXPECT_NEAR(fresh.quantile[1], (1.0 + life.spall_growth) * life.bearing_l10, 0.01 * life.bearing_l10);
  EXPECT_NEAR(fresh.quantile[2], (1.0 + life.spall_growth) * life.bearing_l50, 0.01 * life.bearing_l50);
  EXPECT_TRUE(std::is_sorted(fresh.quantile.begin(), fresh.quantile.end()));
  // Weibull's distribution of those that have lasted: in closed form, far into its tail.
  const BearingLife bearing(life);
  for (const double hours : { 1e4, 1e5, 1e6 })
  {
    const double turns = hours * turns_per_hour / (1.0 + life.spall_growth);
    const double lasted = std::pow(turns / bearing.scale, bearing.shape);
    const double median = bearing.scale * std::pow(lasted + std::log(2.0), 1.0 / bearing.shape);
    EXPECT_NEAR(drives.remaining({ 0.0, 0.0, 0.0, hours * turns_per_hour }, rated, nullptr, {}).quantile[2],
                (median * (1.0 + life.spall_growth)) / turns_per_hour - hours, 300.0)
        << hours;
  }
}

/// In windows that would show play.
Assessment foundNothing()
{
  Assessment silent;
  silent.state = AssessmentState::ASSESSED;
  silent.shows_play = true;
  return silent;
}

TEST(RemainingLife, DensityIsOneInSumAndHasTheQuantiles)
{
  const FlankUse use;
  const Assessment found = foundWear(0.3, 0.1);
  for (const Assessment* assessment : { static_cast<const Assessment*>(nullptr), &found })
  {
    const RemainingHours remaining = use.after(100.0, assessment);
    double reached = 0.0;
    EXPECT_NEAR(std::accumulate(remaining.by_cause.begin(), remaining.by_cause.end(), 0.0), 1.0, 1e-9);
    for (std::size_t bin = 0; bin < RemainingHours::BINS; ++bin)
    {
      EXPECT_GE(remaining.probability[bin], 0.0);
      const double next = reached + remaining.probability[bin];
      for (std::size_t i = 0; i < remaining.quantile.size(); ++i)
      {
        if (remaining.quantile[i] >= RemainingHours::edge(bin) &&
            (bin + 1 == RemainingHours::BINS || remaining.quantile[i] < RemainingHours::edge(bin + 1)))
        {
          EXPECT_GE(RemainingHours::SHARES[i], reached - 1e-9) << i;
          EXPECT_LE(RemainingHours::SHARES[i], next + 1e-9) << i;
        }
      }
      reached = next;
    }
    EXPECT_NEAR(reached, 1.0, 1e-9);
  }
  EXPECT_NEAR(RemainingHours::edge(1), 10.0, 1e-9);
  EXPECT_NEAR(RemainingHours::edge(RemainingHours::BINS - 1), 1e6, 1e-3);
}

TEST(RemainingLife, ScoreIsThatOfTheDistribution)
{
  RemainingHours
      even;  // over one bin, 10 b ... 20 b h: CRPS of a uniform distribution of width w at u is w (1/3 - u + u^2)
  constexpr std::size_t BIN = 40;
  even.probability[BIN] = 1.0;
  const double from = RemainingHours::edge(BIN);
  const double bin_width = RemainingHours::edge(BIN + 1) - from;
  for (const double u : { 0.0, 0.25, 0.7, 1.0 })
  {
    EXPECT_NEAR(even.crps(from + u * bin_width), bin_width * (1.0 / 3.0 - u + u * u), 1e-9 * from) << u;
  }
  EXPECT_NEAR(even.crps(from - 3.0), 3.0 + bin_width / 3.0, 1e-9 * from);
  EXPECT_NEAR(even.crps(2e6), 2e6 - from - bin_width * 2.0 / 3.0, 1e-6 * from);
}

TEST(RemainingLife, NarrowsByWhatIsFoundTheMoreTheSurerItIs)
{
  const FlankUse use;
  const double hours = 100.0;
  const double severity = 0.3;
  const RemainingHours prior = use.after(hours, nullptr);
  const Assessment vague = foundWear(severity, severity);
  const Assessment sure = foundWear(severity, 0.1 * severity);
  const RemainingHours found = use.after(hours, &vague);
  const RemainingHours known = use.after(hours, &sure);
  EXPECT_LT(width(found), width(prior));
  EXPECT_LT(width(known), 0.5 * width(found));
  const double depth = severity * use.parameters.fault_scale.tooth_wear_depth;
  const double left = hours * (use.parameters.life.flank_wear_limit / depth - 1.0);
  EXPECT_NEAR(known.quantile[2], left, 0.1 * left);
  EXPECT_GT(known.by_cause[0], 0.98);
}

TEST(RemainingLife, TakesSilenceForLittleWear)
{
  const FlankUse use;
  const Assessment silent = foundNothing();
  const RemainingHours prior = use.after(500.0, nullptr);
  const RemainingHours remaining = use.after(500.0, &silent);
  EXPECT_GT(remaining.quantile[1], prior.quantile[1]);
  Assessment blind = silent;
  blind.shows_play = false;
  EXPECT_EQ(use.after(500.0, &blind).quantile, prior.quantile);
  const Assessment found = foundWear(0.3, 0.1);
  EXPECT_FALSE(supersedes(blind, silent));
  EXPECT_FALSE(supersedes({}, silent));
  Assessment too_few;
  too_few.state = AssessmentState::TOO_FEW_WINDOWS;
  EXPECT_FALSE(supersedes(too_few, {}));
  EXPECT_TRUE(supersedes(silent, blind));
  EXPECT_TRUE(supersedes(blind, found));
  EXPECT_TRUE(supersedes(found, silent));
}

TEST(RemainingLife, KnowsThatAReferenceOfAWornDriveHidesItsWear)
{
  const FlankUse use;
  const Assessment silent = foundNothing();
  RemainingLife drives(use.parameters);
  const Usage so_far = use.until(500.0);
  const auto median = [&](double reference_hours)
  { return drives.remaining(so_far, use.ahead, &silent, use.until(reference_hours)).quantile[2]; };
  EXPECT_LT(median(250.0), median(0.0));
  EXPECT_NEAR(median(499.9), use.after(500.0, nullptr).quantile[2], 1e-6);
}

TEST(RemainingLife, AlarmOfWhatDoesNotAgeChangesNothing)
{
  const FlankUse use;
  Assessment other = foundWear(0.3, 0.1);
  other.cause = causeOf(FaultKind::PITTING);
  const auto with = use.after(100.0, &other).quantile;
  const auto without = use.after(100.0, nullptr).quantile;
  for (std::size_t i = 0; i < without.size(); ++i)
  {
    EXPECT_NEAR(with[i], without[i], 0.01 * without[i]);  // two of 4096 drives may change places by rounding
  }
}

TEST(RemainingLife, KnowsASpallWhoseRaceIsNamed)
{
  Parameters parameters = shippedParameters();
  const double turns = 1e9;
  FutureLoad ahead{ 1000.0, { {}, { 0.0, 0.0, 0.0, 0.01 * turns } } };
  Assessment spall = foundWear(0.5, 0.05);
  spall.cause = causeOf(FaultKind::BEARING_OUTER_RACE);
  RemainingLife drives(parameters);
  const RemainingHours prior = drives.remaining({ 0.0, 0.0, 0.0, turns }, ahead, nullptr, {});
  const RemainingHours found = drives.remaining({ 0.0, 0.0, 0.0, turns }, ahead, &spall, {});
  EXPECT_LT(found.quantile[2], 0.1 * prior.quantile[2]);
  EXPECT_GT(found.by_cause[2], 0.99);
}

TEST(RemainingLife, IsFiniteForAnyUseAndAssessmentAndDoesNotAllocate)
{
  const FlankUse use;
  RemainingLife drives(use.parameters);
  for (const double hours : { 0.0, 1e-6, 1e3, 1e9 })
  {
    for (const double severity : { 0.0, 1e-3, 1.0 })
    {
      const Assessment found = foundWear(severity, 0.5 * severity);
      const Usage so_far{ hours * use.hourly, hours * use.hourly, hours * use.hourly, hours * 1e5 };
      const std::size_t before = allocationCount();
      const RemainingHours remaining = drives.remaining(so_far, use.ahead, &found, {});
      EXPECT_EQ(allocationCount(), before) << hours;
      const double sum = std::accumulate(remaining.probability.begin(), remaining.probability.end(), 0.0);
      EXPECT_NEAR(sum, 1.0, 1e-9) << hours << " h, severity " << severity;
      EXPECT_TRUE(std::is_sorted(remaining.quantile.begin(), remaining.quantile.end()));
      EXPECT_GE(remaining.quantile[0], 0.0);
    }
  }
}

TEST(LifeTrials, IntervalsHoldTheTruthAsOftenAsTheySayAndAssessmentsImproveThem)
{
  const RatedUse& use = ratedUse();
  const LifeTrialOptions options{ 100, 11, 4000.0, true };
  const std::vector<LifeTrial> trials = runLifeTrials(use.parameters, use.ageing, options, 1e6, [](double) {});
  const Coverage all = coverage(trials, 0.0);
  ASSERT_GT(all.forecasts, 400);
  EXPECT_GT(all.share(), 0.70);
  EXPECT_LT(all.share(), 0.90);
  double score = 0.0;
  double of_readings = 0.0;
  double of_prior = 0.0;
  for (const LifeTrial& trial : trials)
  {
    for (const LifeForecast& forecast : trial.forecasts)
    {
      score += forecast.forecast.crps(forecast.remaining);
      of_readings += forecast.read.crps(forecast.remaining);
      of_prior += forecast.prior.crps(forecast.remaining);
    }
  }
  EXPECT_LT(score, of_prior);
  EXPECT_LT(of_readings, score);
}

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

constexpr std::array TOLD{ indexOf(ScalarIndicator::LOST_MOTION), indexOf(ScalarIndicator::TORSIONAL_STIFFNESS),
                           indexOf(ScalarIndicator::SECOND_STIFFNESS) };

/// Of lost motion, K1 and K2 when sound, and by which shares of these they differ.
WindowResidual residualOf(const std::array<double, 3>& sound, const std::array<double, 3>& share)
{
  WindowResidual residual;
  for (std::size_t i = 0; i < TOLD.size(); ++i)
  {
    residual.sound[TOLD[i]] = sound[i];
    residual.difference[TOLD[i]] = share[i] * sound[i];
    residual.own[TOLD[i]] = 1e-6 * sound[i] * sound[i];
  }
  return residual;
}

/// Signatures of a gear whose lost motion, K1 and K2 wear moves evenly.
SignatureSet evenSignatures()
{
  SignatureSet set;
  const auto add = [&](FaultKind kind, const std::array<double, 3>& changes)
  {
    for (const double severity : { 0.1, 0.5, 1.0 })
    {
      Signature& signature = set.signatures.emplace_back(Signature{ causeOf(kind), severity, ANY_MOTION, {} });
      for (std::size_t i = 0; i < TOLD.size(); ++i)
      {
        signature.change[TOLD[i]] = changes[i] * severity;
      }
    }
  };
  add(FaultKind::TOOTH_WEAR, { 10.0, -0.2, 0.02 });
  add(FaultKind::INTERFACE_WEAR, { 0.0, -0.2, -0.1 });
  return set;
}

TEST(WearReading, IsTheSeveritiesThatMakeTheDifferences)
{
  SignatureSet set = evenSignatures();
  constexpr double PLAY = 2e-4;
  constexpr double STIFFNESS = 3e4;
  for (const auto& [flank, interface] : { std::pair{ 0.0, 0.0 }, { 0.3, 0.7 }, { 1.3, 0.05 } })
  {
    WindowResidual residual = residualOf({ PLAY, STIFFNESS, STIFFNESS }, { 10.0 * flank, -0.2 * flank - 0.2 * interface,
                                                                           0.02 * flank - 0.1 * interface });
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
  const WindowResidual residual = residualOf({ 2e-4, 3e4, 5e4 }, { 3.0, -0.1, -0.1 });
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
  Assessment worn = foundWear(0.5, 0.05);
  worn.confidence = 0.7;
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
