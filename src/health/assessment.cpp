// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/assessment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "health/signature_file.hpp"

namespace hjt
{
namespace
{
// Least number of windows in a mean, so that the mean can omit an outlier. So many successive means change the level.
constexpr int LEAST_EVIDENCE = 3;
}  // namespace

const char* levelName(HealthLevel level) noexcept
{
  constexpr std::array NAMES{ "OK", "WARN", "ERROR" };
  return NAMES[static_cast<std::size_t>(level)];
}

std::string whyNotJudged(const Assessment& assessment)
{
  const std::string here = std::to_string(assessment.windows_here);
  const std::string needed = std::to_string(assessment.windows_needed);
  switch (assessment.state)
  {
    case AssessmentState::WAITING:
      return "no window of the indicators is complete yet";
    case AssessmentState::LEARNING:
      return "the healthy reference is being learned: it has " + here + " of " + needed +
             " windows at this operating point";
    case AssessmentState::NO_REFERENCE:
      return assessment.windows_here == 0 ?
                 "there is no healthy reference for this operating point" :
                 "the healthy reference needs " + needed + " windows at this operating point, but has " + here;
    case AssessmentState::TOO_FEW_WINDOWS:
      return "too few windows: a verdict needs " + needed + " at one operating point, but there are " + here;
    case AssessmentState::OTHER_PAYLOAD:
      return "the reference has no windows with this payload, load or gain of the current: add windows with this "
             "payload and load to the reference, or correct the torque per current";
    case AssessmentState::ASSESSED:
      break;
  }
  return {};
}

Assessor::Assessor(const Parameters& parameters)
  : signatures_(loadSignatures(parameters.indicators.signatures))
  , least_windows_(std::min(parameters.indicators.evidence_windows, LEAST_EVIDENCE))
  , error_factor_(parameters.indicators.error_factor)
  , baseline_(parameters, signatures_)
  , patterns_(signatures_)
  , cause_search_(signatures_)
{
}

void Assessor::reset() noexcept
{
  baseline_.reset();
  deviations_ = {};
  assessment_ = settled_ = {};
  is_searching_ = false;
  worse_ = 0;
  better_ = 0;
}

const Assessment& Assessor::update(const SignalIndicators& indicators, const SignalIndicators* model) noexcept
{
  begin(indicators, model);
  advance(searchLength());
  return settled_;
}

void Assessor::begin(const SignalIndicators& indicators, const SignalIndicators* model) noexcept
{
  advance(searchLength());  // finishes the search for the cause of the last window
  judge(indicators, model);
  if (!is_searching_)
  {
    settled_ = assessment_;
  }
}

/// Judges a window. The function starts the search for the cause of an alarm and leaves the rest to `advance`.
void Assessor::judge(const SignalIndicators& indicators, const SignalIndicators* model) noexcept
{
  assessment_.stamp = indicators.stamp;
  assessment_.windows = indicators.windows;
  const AssessmentState compared = baseline_.update(indicators, model, deviations_);
  if (compared != AssessmentState::ASSESSED)
  {
    setState(compared);
    return;
  }
  const FeatureScores scores = featureScores(deviations_);
  assessment_.shows_play = scores[static_cast<std::size_t>(Feature::LOST_MOTION)].compared;
  updateLevel(levelOf(scores, indicators.point));
  setState(compared);
  if (assessment_.level == HealthLevel::OK)
  {
    assessment_.cause = Cause::NONE;
    assessment_.confidence = 0.0;
    assessment_.severity = 0.0;
    assessment_.severity_deviation = 0.0;
    assessment_.alternative_count = 0;
    assessment_.evidence_count = 0;
  }
  else if (assessment_.largest_score >
           1.0)  // if not, this window has no evidence, and the last causes stay until the level falls
  {
    listEvidence(indicators, scores);
    if (!signatures_->signatures
             .empty())  // without signatures the cause is unknown, and NONE would say that no known cause fits
    {
      point_ = indicators.point;
      cause_search_.start();
      is_searching_ = true;
    }
  }
}

void Assessor::search(std::size_t signatures) noexcept
{
  cause_search_.advance(baseline_.residual(), point_, signatures);
  if (cause_search_.isDone())
  {
    is_searching_ = false;
    explain(cause_search_.posterior());
    settled_ = assessment_;
  }
}

void Assessor::setState(AssessmentState state) noexcept
{
  assessment_.windows_here = baseline_.windowsHere();
  assessment_.windows_needed = baseline_.windowsNeeded();
  assessment_.state = state;
  if (state == AssessmentState::ASSESSED)
  {
    assessment_.windows_needed = 2 * least_windows_ - 1;  // number of windows in least_windows_ successive means
    const bool is_verdict =
        assessment_.level != HealthLevel::OK || assessment_.windows_here >= assessment_.windows_needed;
    assessment_.state = is_verdict ? state : AssessmentState::TOO_FEW_WINDOWS;
  }
}

HealthLevel Assessor::levelOf(const FeatureScores& scores, const OperatingPoint& point) noexcept
{
  const PatternScore pattern = patterns_.strongest(baseline_.residual(), point);
  const Deviation along = baseline_.pattern(pattern.student);
  const double by_pattern = along.score / baseline_.patternThreshold();
  double largest = 0.0;
  double factor = along.threshold_factor;
  for (const FeatureScore& feature : scores)
  {
    largest = std::max(largest, std::abs(feature.score));
    factor = std::max(factor, feature.threshold_factor);
  }
  largest /= baseline_.threshold();
  assessment_.pattern = by_pattern > largest ? pattern.cause : Cause::NONE;
  assessment_.largest_score = std::max(largest, by_pattern);
  if (assessment_.largest_score <= 1.0)
  {
    return HealthLevel::OK;
  }
  return factor > error_factor_ ? HealthLevel::ERROR : HealthLevel::WARN;
}

/// Changes the level when least_windows_ successive means of the last windows agree on a higher, or a lower, level. The
/// level falls only by windows of the class of operating points that showed it, because another class may hide a fault.
void Assessor::updateLevel(HealthLevel level) noexcept
{
  if (baseline_.residual().windows < least_windows_)
  {
    return;
  }
  if (level > assessment_.level)
  {
    least_worse_ = worse_ == 0 ? level : std::min(least_worse_, level);
    better_ = 0;
    if (++worse_ >= least_windows_)
    {
      assessment_.level = least_worse_;
      shown_in_ = baseline_.bin();
      worse_ = 0;
    }
  }
  else if (level == assessment_.level)
  {
    shown_in_ = baseline_.bin();
    worse_ = 0;
    better_ = 0;
  }
  else if (baseline_.bin() == shown_in_)
  {
    most_better_ = better_ == 0 ? level : std::max(most_better_, level);
    worse_ = 0;
    if (++better_ >= least_windows_)
    {
      assessment_.level = most_better_;
      better_ = 0;
    }
  }
}

/// Fills cause, severity and alternatives of an alarm.
void Assessor::explain(const CausePosterior& posterior) noexcept
{
  std::array<std::size_t, CAUSE_COUNT> sorted{};
  std::iota(sorted.begin(), sorted.end(), std::size_t{ 0 });
  const std::array<double, CAUSE_COUNT>& probability = posterior.probability;
  std::sort(sorted.begin(), sorted.end(),
            [&probability](std::size_t a, std::size_t b) { return probability[a] > probability[b]; });
  const std::size_t best = sorted.front();
  assessment_.cause = static_cast<Cause>(best);
  assessment_.confidence = probability[best];
  assessment_.severity = posterior.severity[best];
  assessment_.severity_deviation = posterior.severity_deviation[best];
  assessment_.alternative_count = 0;
  double sum = probability[best];
  while (sum < Assessment::SET && assessment_.alternative_count < Assessment::MAX_ALTERNATIVES)
  {
    const std::size_t next = sorted[assessment_.alternative_count + 1];
    assessment_.alternatives[assessment_.alternative_count++] = { static_cast<Cause>(next), probability[next],
                                                                  posterior.severity[next],
                                                                  posterior.severity_deviation[next] };
    sum += probability[next];
  }
}

/// Lists the indicators beyond the threshold, or the indicator with the largest score if none is beyond it.
void Assessor::listEvidence(const SignalIndicators& indicators, const FeatureScores& scores) noexcept
{
  std::array<FeatureScore, FEATURE_COUNT> sorted = scores;
  std::sort(sorted.begin(), sorted.end(),
            [](const FeatureScore& a, const FeatureScore& b) { return std::abs(a.score) > std::abs(b.score); });
  assessment_.evidence_count = 0;
  for (const FeatureScore& feature : sorted)
  {
    const bool is_beyond = std::abs(feature.score) > baseline_.threshold();
    if (assessment_.evidence_count == Assessment::MAX_EVIDENCE || (assessment_.evidence_count > 0 && !is_beyond))
    {
      break;
    }
    assessment_.evidence[assessment_.evidence_count++] = { feature.indicator, indicators.values[feature.indicator],
                                                           deviations_[feature.indicator].expected, feature.score };
  }
}
}  // namespace hjt
