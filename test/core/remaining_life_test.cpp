// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "test/support/allocation_count.hpp"
#include "test/support/temporary_folder.hpp"
#include "test_parameters.hpp"

#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "life/drive_ageing.hpp"
#include "life/life_estimate.hpp"
#include "life/revolution_load_map.hpp"
#include "studies/life_trials.hpp"
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

Assessment foundWear(double severity, double deviation)
{
  Assessment assessment;
  assessment.state = AssessmentState::ASSESSED;
  assessment.level = HealthLevel::WARN;
  assessment.cause = causeOf(FaultKind::TOOTH_WEAR);
  assessment.confidence = 1.0;
  assessment.severity = severity;
  assessment.severity_deviation = deviation;
  return assessment;
}

TEST(RemainingLife, DensityIsOneInSumAndHasTheQuantiles)
{
  const FlankUse use;
  const Assessment found = foundWear(0.3, 0.1);
  for (const Assessment* assessment : { static_cast<const Assessment*>(nullptr), &found })
  {
    const RemainingHours remaining = use.after(100.0, assessment);
    double reached = 0.0;
    double causes = 0.0;
    for (const double share : remaining.by_cause)
    {
      causes += share;
    }
    EXPECT_NEAR(causes, 1.0, 1e-9);
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
  Assessment silent;
  silent.state = AssessmentState::ASSESSED;
  silent.shows_play = true;
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
  Assessment silent;
  silent.state = AssessmentState::ASSESSED;
  silent.shows_play = true;
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
      double sum = 0.0;
      for (const double share : remaining.probability)
      {
        sum += share;
      }
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

}  // namespace
}  // namespace hjt
