// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/fault_signatures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "health/fitted_signatures.hpp"
#include "health/indicator_table.hpp"

namespace hjt
{
namespace
{
constexpr double INVERSE_TEMPERATURE = 20.0;
constexpr double NOISE =
    2.0;  // a score within it says nothing: amplitudes are never below zero, and would point everywhere

constexpr std::array FEATURE_NAMES{ "ratio",      "kinematic_error", "stiffness",       "lost_motion",
                                    "loop",       "running_torque",  "coulomb",         "viscous",
                                    "efficiency", "residual",        "impulses",        "order_1",
                                    "order_2",    "order_4",         "circular_spline", "cage",
                                    "ball",       "outer",           "inner",           "tooth_pass" };
static_assert(FEATURE_NAMES.size() == FEATURE_COUNT, "a name for each Feature");

/// However large a fault has grown, its direction is nearly the same.
double compressed(double score) noexcept
{
  return std::copysign(std::asinh(std::max(std::abs(score) - NOISE, 0.0)), score);
}

/// Cosine of the angle between the scores and a signature, over the features compared; 0 if they say nothing.
double cosineSimilarity(const FeatureScores& scores, const Signature& signature) noexcept
{
  double product = 0.0;
  double score_square = 0.0;
  double direction_square = 0.0;
  for (std::size_t i = 0; i < FEATURE_COUNT; ++i)
  {
    if (scores[i].compared)
    {
      const double score = compressed(scores[i].score);
      product += score * signature.direction[i];
      score_square += score * score;
      direction_square += signature.direction[i] * signature.direction[i];
    }
  }
  const double square = score_square * direction_square;
  return square > 0.0 ? product / std::sqrt(square) : 0.0;
}

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
    for (const LineSignal signal : { LineSignal::KINEMATIC_ERROR, LineSignal::MOTOR_TORQUE })
    {
      const std::size_t indicator = amplitudeIndex(signal, index(line));
      single(feature, indicator, std::max(deviations_[indicator].score, 0.0));
    }
  }

  /// A line with a phase: how far its vector has moved. Less one degree of freedom, so that noise scores as much as
  /// else.
  void vector(Feature feature, Line line) const noexcept
  {
    for (const LineSignal signal : { LineSignal::KINEMATIC_ERROR, LineSignal::MOTOR_TORQUE })
    {
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

const char* featureName(Feature feature) noexcept
{
  return FEATURE_NAMES[static_cast<std::size_t>(feature)];
}

const std::vector<Signature>& faultSignatures() noexcept
{
  return FITTED_SIGNATURES;
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
    if (index(row.line) < PHASE_LOCKED)
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

std::array<double, CAUSE_COUNT> causeProbabilities(const FeatureScores& scores) noexcept
{
  std::array<double, CAUSE_COUNT> probabilities{};
  for (const Signature& signature : FITTED_SIGNATURES)
  {
    double& probability = probabilities[static_cast<std::size_t>(signature.cause)];
    probability = std::max(probability, std::exp(INVERSE_TEMPERATURE * cosineSimilarity(scores, signature)));
  }
  const double sum = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
  for (double& probability : probabilities)
  {
    probability /= sum;
  }
  return probabilities;
}
}  // namespace hjt
