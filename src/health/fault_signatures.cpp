// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/fault_signatures.hpp"

#include <algorithm>
#include <cmath>

#include "health/indicator_table.hpp"

namespace hjt
{
namespace
{
/// Gathers the deviations of one feature.
class Gatherer
{
public:
  Gatherer(const Deviations& deviations, FeatureScores& scores) : deviations_(deviations), scores_(scores) {}

  void scalar(Feature feature, ScalarIndicator indicator) const noexcept
  {
    single(feature, indexOf(indicator), deviations_[indexOf(indicator)].score);
  }

  /// A line that only grows: what lies below its mean is no fault.
  void amplitude(Feature feature, Line line) const noexcept
  {
    for (const LineSignal signal : ALL_LINE_SIGNALS)
    {
      const std::size_t indicator = amplitudeIndex(signal, index(line));
      single(feature, indicator, std::max(deviations_[indicator].score, 0.0));
    }
  }

  /// A line with a phase: how far its vector has moved. Less one degree of freedom, so that noise scores as much as
  /// else.
  void vector(Feature feature, Line line) const noexcept
  {
    for (const LineSignal signal : ALL_LINE_SIGNALS)
    {
      if (!hasLine(signal, index(line)))
      {
        continue;
      }
      const Deviation& cosine = deviations_[cosineIndex(signal, index(line))];
      const Deviation& sine = deviations_[sineIndex(signal, index(line))];
      const double square = cosine.score * cosine.score + sine.score * sine.score - 1.0;
      const double factor = std::hypot(cosine.threshold_factor, sine.threshold_factor);
      take(feature, amplitudeIndex(signal, index(line)), std::sqrt(std::max(square, 0.0)), factor);
    }
  }

private:
  void single(Feature feature, std::size_t indicator, double score) const noexcept
  {
    take(feature, indicator, score, score == 0.0 ? 0.0 : deviations_[indicator].threshold_factor);
  }

  void take(Feature feature, std::size_t indicator, double score, double factor) const noexcept
  {
    FeatureScore& best = scores_[static_cast<std::size_t>(feature)];
    if (std::isfinite(score) && (!best.compared || std::abs(score) > std::abs(best.score)))
    {
      best = { score, factor, indicator, true };
    }
  }

  const Deviations& deviations_;
  FeatureScores& scores_;
};
}  // namespace

const char* causeName(Cause cause) noexcept
{
  if (cause == Cause::NONE || cause == Cause::CIRCULAR_SPLINE_TOOTH)
  {
    return cause == Cause::NONE ? "none" : "circular_spline_tooth";
  }
  const std::size_t kind = static_cast<std::size_t>(cause) - static_cast<std::size_t>(Cause::FIRST_FAULT);
  return describe(static_cast<FaultKind>(kind)).name;
}

std::vector<Cause> causesThatMove(const SignatureSet& set, ScalarIndicator indicator, double sign, double share)
{
  std::vector<Cause> causes;
  for (const Signature& signature : set.signatures)
  {
    const double least = share * (isShare(signature.cause, indicator) ? 1.0 : std::abs(set.sound[indexOf(indicator)]));
    if (signature.severity == 1.0 && sign * signature.change[indexOf(indicator)] >= least &&
        std::find(causes.begin(), causes.end(), signature.cause) == causes.end())
    {
      causes.push_back(signature.cause);
    }
  }
  return causes;
}

FeatureScores featureScores(const Deviations& deviations) noexcept
{
  FeatureScores scores{};
  const Gatherer gather(deviations, scores);
  for (const ScalarRow& row : SCALARS)
  {
    gather.scalar(row.feature, row.indicator);
  }
  for (const LineRow& row : LINES)
  {
    if (isPhaseLocked(index(row.line)))
    {
      gather.vector(row.feature, row.line);
    }
    else
    {
      gather.amplitude(row.feature, row.line);
    }
  }
  return scores;
}
}  // namespace hjt
