// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <boost/math/distributions/normal.hpp>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
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

class FalseAlarms : public testing::TestWithParam<Case>
{
};

constexpr double PROMISED = 0.01;

TEST_P(FalseAlarms, AreAboutAsManyAsPromised)
{
  const Case& given = GetParam();
  SoundDrives drives(given.draw, given.reference, given.evidence, PROMISED);
  const double share = drives.alarms(given.drives, given.verdicts);
  std::printf("%s: %.4f of verdicts, promised %.4f\n", given.name, share, PROMISED);
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
    std::printf("%d windows: %.2f\n", reference, score);
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
