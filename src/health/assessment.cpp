// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/assessment.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hjt
{
const char* levelName(HealthLevel level) noexcept
{
  constexpr std::array NAMES{ "OK", "WARN", "ERROR" };
  return NAMES[static_cast<std::size_t>(level)];
}

Assessor::Assessor(const Parameters& parameters)
  : confirm_windows_(parameters.indicators.confirm_windows)
  , error_factor_(parameters.indicators.error_factor)
  , baseline_(parameters)
{
}

void Assessor::reset() noexcept
{
  baseline_.reset();
  deviations_ = {};
  assessment_ = {};
  worse_ = 0;
  better_ = 0;
}

const Assessment& Assessor::update(const SignalIndicators& indicators) noexcept
{
  assessment_.stamp = indicators.stamp;
  assessment_.windows = indicators.windows;
  switch (baseline_.update(indicators, deviations_))
  {
    case BaselineState::LEARNING:
      assessment_.state = AssessmentState::LEARNING;
      return assessment_;
    case BaselineState::NO_REFERENCE:
      assessment_.state = AssessmentState::NO_REFERENCE;
      return assessment_;
    case BaselineState::COMPARED:
      break;
  }
  assessment_.state = AssessmentState::ASSESSED;
  const FeatureScores plain = featureScores(deviations_.plain);
  const FeatureScores conditional = featureScores(deviations_.conditional);
  assessment_.largest_score = 0.0;
  const HealthLevel level = levelOf(plain);
  updateLevel(std::max(level, levelOf(conditional)));
  // The signatures are of what a fault does to each indicator: where only their relation shows it, the cause is open.
  if (level != HealthLevel::OK)
  {
    explain(indicators, plain, deviations_.plain, causeProbabilities(plain));
  }
  else
  {
    explain(indicators, conditional, deviations_.conditional, {});
  }
  return assessment_;
}

HealthLevel Assessor::levelOf(const FeatureScores& scores) noexcept
{
  double largest = 0.0;
  double factor = 0.0;
  for (const FeatureScore& feature : scores)
  {
    largest = std::max(largest, std::abs(feature.score));
    factor = std::max(factor, feature.threshold_factor);
  }
  assessment_.largest_score = std::max(assessment_.largest_score, largest / baseline_.threshold());
  if (largest <= baseline_.threshold())
  {
    return HealthLevel::OK;
  }
  return factor > error_factor_ ? HealthLevel::ERROR : HealthLevel::WARN;
}

/// Lets the level follow once enough windows in a row agree.
void Assessor::updateLevel(HealthLevel level) noexcept
{
  if (level > assessment_.level)
  {
    least_worse_ = worse_ == 0 ? level : std::min(least_worse_, level);
    better_ = 0;
    if (++worse_ >= confirm_windows_)
    {
      assessment_.level = least_worse_;
      worse_ = 0;
    }
  }
  else if (level < assessment_.level)
  {
    most_better_ = better_ == 0 ? level : std::max(most_better_, level);
    worse_ = 0;
    if (++better_ >= confirm_windows_)
    {
      assessment_.level = most_better_;
      better_ = 0;
    }
  }
  else
  {
    worse_ = 0;
    better_ = 0;
  }
}

void Assessor::explain(const SignalIndicators& indicators, const FeatureScores& scores, const Deviations& deviations,
                       const std::array<double, CAUSE_COUNT>& probabilities) noexcept
{
  if (assessment_.level == HealthLevel::OK)
  {
    assessment_.cause = Cause::NONE;
    assessment_.confidence = 0.0;
    assessment_.evidence_count = 0;
    return;
  }
  if (assessment_.largest_score <= 1.0)
  {
    return;  // no evidence in this window: the causes stand until the level falls
  }
  // That something is wrong is settled: only what, is asked. All zero: NONE, the first.
  const auto best = std::max_element(probabilities.begin(), probabilities.end());
  assessment_.cause = static_cast<Cause>(best - probabilities.begin());
  assessment_.confidence = *best;
  std::array<FeatureScore, FEATURE_COUNT> sorted = scores;
  std::sort(sorted.begin(), sorted.end(),
            [](const FeatureScore& a, const FeatureScore& b) { return std::abs(a.score) > std::abs(b.score); });
  assessment_.evidence_count = 0;
  for (const FeatureScore& feature : sorted)
  {
    if (assessment_.evidence_count == Assessment::MAX_EVIDENCE || std::abs(feature.score) <= baseline_.threshold())
    {
      break;
    }
    assessment_.evidence[assessment_.evidence_count++] = { feature.indicator, indicators.values[feature.indicator],
                                                           deviations[feature.indicator].expected, feature.score };
  }
}
}  // namespace hjt
