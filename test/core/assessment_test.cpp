// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <boost/math/distributions/normal.hpp>

#include "health/signature_terms.hpp"
#include "test/core/signal_monitor_support.hpp"
#include "test/support/seeded_random.hpp"

namespace hjt
{
namespace
{
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
  SeededRandom random_{ 11 };
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
              "too few windows: a verdict needs 5 at one operating point, but there are " + std::to_string(here));
  }
  EXPECT_EQ(windows(1).state, AssessmentState::ASSESSED);
  EXPECT_GE(assessor_.assessment().level, HealthLevel::WARN);
  EXPECT_EQ(whyNotJudged(assessor_.assessment()), "");
}

TEST_F(Assessed, ReferenceOfTooFewWindowsSaysHowManyItHasAndAWholeOneServesACheckUpOfOneWindow)
{
  windows(6);
  Assessor given(shippedParameters());
  given.setReference(assessor_.baseline().bins());
  const Assessment& assessment = given.update(joint_.nextWindow());
  EXPECT_EQ(assessment.state, AssessmentState::NO_REFERENCE);
  EXPECT_EQ(whyNotJudged(assessment), "the healthy reference needs 8 windows at this operating point, but has 6");
  windows(LEARNING - 6);
  Assessor once(shippedParameters({ "indicators.evidence_windows=1" }));
  once.setReference(assessor_.baseline().bins());
  EXPECT_EQ(once.update(joint_.nextWindow()).state, AssessmentState::ASSESSED);
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

TEST_F(Assessed, SoundJointTellsFromWhichSeverityOnAFaultWouldHaveShown)
{
  joint_.speed = [](double) { return 141.0; };  // as signatures have it: they tell of lines
  windows(LEARNING + 5);
  const OperatingPoint point = joint_.nextWindow().point;
  const SeenFrom fine = seenFrom(assessor_, point);
  const auto of = [](const SeenFrom& seen, FaultKind kind) { return seen[static_cast<std::size_t>(causeOf(kind))]; };
  EXPECT_LT(of(fine, FaultKind::TOOTH_TIP_CRACK), 1.0);
  EXPECT_TRUE(std::isnan(fine[static_cast<std::size_t>(Cause::NONE)])) << "has no signature";
  noise_ = std::normal_distribution<double>(0.0, 30.0);
  joint_.ripple = [this](double, double, double) { return 1e-3 * noise_(random_); };
  Assessor coarse(shippedParameters());
  for (int i = 0; i < LEARNING + 5; ++i)
  {
    coarse.update(joint_.nextWindow());
  }
  const SeenFrom noisy = seenFrom(coarse, point);
  for (std::size_t cause = 1; cause < CAUSE_COUNT; ++cause)
  {
    EXPECT_GE(noisy[cause], fine[cause]) << causeName(static_cast<Cause>(cause));
  }
  EXPECT_GT(of(noisy, FaultKind::TOOTH_TIP_CRACK), of(fine, FaultKind::TOOTH_TIP_CRACK));
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
  fault_amplitude_ = 0.1;
  EXPECT_LT(windows(1).largest_score, 1.0);
  EXPECT_GE(windows(12).level, HealthLevel::WARN);
}

/// At one speed a brake that drags, which is no fault of a gear, looks the same.
TEST_F(Assessed, DragIsPutDownToTheLubricantOrToNone)
{
  windows(LEARNING);
  drag_ = 1.6;
  const Assessment& assessment = windows(5);
  EXPECT_GE(assessment.level, HealthLevel::WARN);
  double both = 0.0;
  const auto add = [&](Cause cause, double confidence)
  { both += cause == Cause::NONE || cause == causeOf(FaultKind::LUBRICANT_DEGRADATION) ? confidence : 0.0; };
  add(assessment.cause, assessment.confidence);
  for (std::size_t i = 0; i < assessment.alternative_count; ++i)
  {
    add(assessment.alternatives[i].cause, assessment.alternatives[i].confidence);
    EXPECT_LT(assessment.alternatives[i].confidence, assessment.confidence);
  }
  EXPECT_GT(both, 0.9);
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
      assess(random_.normal(), random_.normal());
    }
  }

  const Assessment& assess(double temperature, double stiffness)
  {
    SignalIndicators window = torqueWindow({ 100.0, 1.0, 30.0, 25.0 }, 0.15 - 0.02 * temperature + noise());
    valueOf(window, ScalarIndicator::COULOMB_TORQUE) = 0.10 - 0.01 * temperature + noise();
    valueOf(window, ScalarIndicator::TORSIONAL_STIFFNESS) = 25000.0 + 300.0 * temperature + 10.0 * stiffness;
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

  double noise() { return 1e-4 * random_.normal(); }

  Assessor assessor_{ shippedParameters({ "indicators.least_spread=0.0" }) };
  SeededRandom random_{ 7 };
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

TEST(Level, IsNotRefutedAtAnotherOperatingPoint)
{
  Assessor assessor(shippedParameters({ "indicators.least_spread=0.0005" }));
  SeededRandom random(3);
  const auto assess = [&](int windows, double temperature, double beside)
  {
    for (int i = 0; i < windows; ++i)
    {
      assessor.update(torqueWindow({ 100.0, 1.0, 30.0, temperature }, 0.15 + 1e-4 * random.normal() + beside));
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

using Random = std::mt19937_64;

/// Of mean 0 and variance 1, `before`: the last one of the same indicator.
using Draw = std::function<double(Random&, double before)>;

double gaussian(Random& random, double /*before*/)
{
  return std::normal_distribution<double>()(random);
}

Draw student(double freedom)
{
  return [freedom](Random& random, double /*before*/)
  { return std::student_t_distribution<double>(freedom)(random) * std::sqrt((freedom - 2.0) / freedom); };
}

Draw correlated(double stays)
{
  return [stays](Random& random, double before)
  { return stays * before + std::sqrt(1.0 - stays * stays) * gaussian(random, 0.0); };
}

/// Windows of sound drives whose indicators are independent numbers, at temperatures and payloads that move them.
class SoundDrives
{
public:
  SoundDrives(Draw draw, int reference, int evidence, double rate)
    : draw_(std::move(draw))
    , reference_(reference)
    , evidence_(evidence)
    , parameters_(shippedParameters({ "indicators.signatures=none", "indicators.least_spread=0.0",
                                      "indicators.baseline_windows=" + std::to_string(reference),
                                      "indicators.evidence_windows=" + std::to_string(evidence),
                                      "indicators.false_alarm_rate=" + std::to_string(rate) }))
  {
  }

  /// Share of verdicts, each of windows of its own, that are beyond the threshold.
  double alarms(int drives, int verdicts)
  {
    int beyond = 0;
    for (int drive = 0; drive < drives; ++drive)
    {
      Assessor assessor(parameters_);
      before_ = {};
      for (int i = 0; i < reference_; ++i)
      {
        assessor.update(window());
      }
      for (int i = 0; i < verdicts * evidence_; ++i)
      {
        const Assessment& assessment = assessor.update(window());
        EXPECT_NE(assessment.state, AssessmentState::LEARNING);
        beyond += (i + 1) % evidence_ == 0 && assessment.largest_score > 1.0 ? 1 : 0;
      }
    }
    return static_cast<double>(beyond) / (drives * verdicts);
  }

  /// Score over the threshold of drives of which one indicator, that goes with the temperature, is so far off [spreads
  /// of a window]: median.
  double score(int drives, double off)
  {
    std::vector<double> scores;
    for (int drive = 0; drive < drives; ++drive)
    {
      Assessor assessor(parameters_);
      before_ = {};
      for (int i = 0; i < reference_ + evidence_; ++i)
      {
        assessor.update(window(i < reference_ ? 0.0 : off));
      }
      scores.push_back(assessor.assessment().largest_score);
    }
    const auto middle = scores.begin() + drives / 2;
    std::nth_element(scores.begin(), middle, scores.end());
    return *middle;
  }

private:
  SignalIndicators window(double off = 0.0)
  {
    const double temperature = std::uniform_real_distribution<double>(-4.0, 4.0)(random_);
    const double weight = std::uniform_real_distribution<double>(-3.0, 3.0)(random_);
    SignalIndicators window;
    window.windows = ++windows_;
    window.point = { 100.0, 0.0, 30.0, 25.0 + temperature, 0.0, 60.0 + weight, 0.0, 4.0 };
    for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
    {
      before_[i] = draw_(random_, before_[i]);
      const double sound = i % 3 == 0 ? 100.0 * (1.0 - 0.02 * temperature + 0.01 * weight) : 100.0;
      window.values[i] = sound + before_[i];
    }
    window.values[indexOf(ScalarIndicator::TORSIONAL_STIFFNESS)] += off;
    return window;
  }

  Draw draw_;
  int reference_;
  int evidence_;
  Parameters parameters_;
  std::array<double, INDICATOR_COUNT> before_{};
  std::uint64_t windows_{};
  Random random_{ 17 };
};

struct Case
{
  const char* name;
  Draw draw;
  int reference;
  int evidence;
  int drives;
  int verdicts;  // of each
};

using FalseAlarms = testing::TestWithParam<Case>;

constexpr double PROMISED = 0.01;

TEST_P(FalseAlarms, AreAboutAsManyAsPromised)
{
  const Case& given = GetParam();
  SoundDrives drives(given.draw, given.reference, given.evidence, PROMISED);
  const double share = drives.alarms(given.drives, given.verdicts);
  EXPECT_LE(share, 2.0 * PROMISED);
  if (given.evidence == 1)
  {
    EXPECT_GE(share, 0.3 * PROMISED) << "nothing is given away";
  }
}

// Those of one reference go together: many drives, few verdicts of each.
INSTANTIATE_TEST_SUITE_P(Tails, FalseAlarms,
                         testing::Values(Case{ "normal_one_of_10", gaussian, 10, 1, 1500, 2 },
                                         Case{ "normal_one_of_40", gaussian, 40, 1, 700, 4 },
                                         Case{ "normal_one_of_160", gaussian, 160, 1, 200, 15 },
                                         Case{ "t10_one_of_40", student(10.0), 40, 1, 700, 4 },
                                         Case{ "t10_one_of_160", student(10.0), 160, 1, 200, 15 },
                                         Case{ "t5_one_of_40", student(5.0), 40, 1, 700, 4 },
                                         Case{ "t5_one_of_160", student(5.0), 160, 1, 200, 15 },
                                         Case{ "normal_ten_of_40", gaussian, 40, 10, 100, 10 },
                                         Case{ "t5_ten_of_40", student(5.0), 40, 10, 100, 10 },
                                         Case{ "stays_ten_of_40", correlated(0.5), 40, 10, 100, 10 },
                                         Case{ "stays_much_ten_of_40", correlated(0.8), 40, 10, 100, 10 }),
                         [](const testing::TestParamInfo<Case>& info) { return info.param.name; });

TEST(MeansOfTen, NeedLittleMoreThanIndependentWindowsWould)
{
  constexpr int REFERENCE = 160;
  constexpr int EVIDENCE = 10;
  SoundDrives drives(gaussian, REFERENCE, EVIDENCE, PROMISED);
  const double quantile = boost::math::quantile(
      boost::math::complement(boost::math::normal(), 0.5 * PROMISED / static_cast<double>(INDICATOR_COUNT)));
  const double least = quantile * std::sqrt(1.0 / EVIDENCE + 1.0 / REFERENCE);
  EXPECT_GT(drives.score(51, 1.5 * least), 1.0);
  EXPECT_LT(drives.score(51, 0.8 * least), 1.0);
}

TEST(SizeOfAReference, MakesNoStepInWhatIsFound)
{
  double before = 0.0;
  for (const int reference : { 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 20, 24, 32 })
  {
    const double score = SoundDrives(gaussian, reference, 1, PROMISED).score(101, 25.0);
    if (reference > 9)
    {
      EXPECT_GT(score, 0.95 * before) << reference;
      EXPECT_LT(score, 1.25 * before) << reference;
    }
    before = score;
  }
  EXPECT_GT(before, 2.0);
}
}  // namespace
}  // namespace hjt
