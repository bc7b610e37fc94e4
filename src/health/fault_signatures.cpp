// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/fault_signatures.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
constexpr double LARGEST_SCORE = 12.0;

// Features: ratio, kinematic error, stiffness, lost motion, loop | running torque, Coulomb, viscous, efficiency
//           | residual, impulses | orders 1, 2, 4, circular spline | cage, ball, outer, inner, tooth pass
/// By cause, in the order of `Feature`: . still, + up, - down, * any.
constexpr std::array<const char*, CAUSE_COUNT> SIGNATURES{
  // none
  "....."
  "...."
  ".."
  "...."
  ".....",
  // interface_wear
  ".*-*."
  "++*-"
  "*."
  ".**."
  ".....",
  // rear_section_crack
  ".*-.*"
  "...."
  "*."
  "**.."
  ".....",
  // lubricant_degradation
  "....."
  "+++-"
  ".."
  "...."
  ".....",
  // tooth_wear
  ".*-++"
  "***."
  "**"
  ".**."
  "....*",
  // tooth_root_crack
  ".+*.."
  "...."
  "**"
  ".+**"
  "....*",
  // flange_crack
  ".*-*."
  "...."
  "*."
  "+*.."
  ".....",
  // tooth_tip_crack
  ".+..."
  "...."
  "++"
  ".+**"
  "....*",
  // pitting
  ".**.."
  "**.*"
  "++"
  ".***"
  "....+",
  // wave_generator_wear
  ".+-+."
  "--*+"
  "*."
  ".++."
  ".....",
  // flexspline_crack
  ".+-.."
  "...."
  "*."
  ".++."
  ".....",
  // buckling
  "++-++"
  "**.-"
  "+*"
  "*++*"
  ".....",
  // ratcheting
  "++.+*"
  "*..*"
  "++"
  "****"
  "....*",
  // bearing_inner_race
  ".*..."
  "*..."
  "*+"
  "...."
  "...+.",
  // bearing_outer_race
  ".*..."
  "*..."
  "*+"
  "...."
  "..+..",
  // bearing_ball
  ".*..."
  "*..."
  "*+"
  "...."
  ".+...",
  // bearing_cage
  ".*..."
  "*..."
  "*."
  "...."
  "+....",
  // circular_spline_tooth
  ".+..."
  "...."
  "**"
  "...+"
  "....*",
};

Move moveOf(char letter) noexcept
{
  switch (letter)
  {
    case '+':
      return Move::UP;
    case '-':
      return Move::DOWN;
    case '*':
      return Move::ANY;
    default:
      return Move::STILL;
  }
}

double normal(double x, double mean, double spread) noexcept
{
  constexpr double ROOT_TWO_PI = 2.5066282746310002;
  const double z = (x - mean) / spread;
  return std::exp(-0.5 * z * z) / (spread * ROOT_TWO_PI);
}

double likelihood(double score, Move move) noexcept
{
  constexpr double WIDE = 8.0;
  const double still = 0.95 * normal(score, 0.0, 1.5) + 0.05 * normal(score, 0.0, WIDE);
  switch (move)
  {
    case Move::UP:
      return 0.2 * still + 0.8 * normal(score, 8.0, 4.0);
    case Move::DOWN:
      return 0.2 * still + 0.8 * normal(score, -8.0, 4.0);
    case Move::ANY:
      return 0.5 * still + 0.5 * normal(score, 0.0, WIDE);
    case Move::STILL:
      break;
  }
  return still;
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

  /// A line with a phase: how far its vector has moved. Less one degree of freedom, so that noise scores as much as else.
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

Move expectedMove(Cause cause, Feature feature) noexcept
{
  return moveOf(SIGNATURES[static_cast<std::size_t>(cause)][static_cast<std::size_t>(feature)]);
}

FeatureScores featureScores(const Deviations& deviations) noexcept
{
  FeatureScores scores{};
  const Gatherer gather(deviations, scores);
  gather.scalar(Feature::RATIO, ScalarIndicator::RATIO_DEVIATION);
  gather.scalar(Feature::KINEMATIC_ERROR, ScalarIndicator::KINEMATIC_ERROR);
  gather.scalar(Feature::STIFFNESS, ScalarIndicator::TORSIONAL_STIFFNESS);
  gather.scalar(Feature::LOST_MOTION, ScalarIndicator::LOST_MOTION);
  gather.scalar(Feature::LOOP_AREA, ScalarIndicator::HYSTERESIS_AREA);
  gather.scalar(Feature::RUNNING_TORQUE, ScalarIndicator::RUNNING_TORQUE);
  gather.scalar(Feature::COULOMB, ScalarIndicator::COULOMB_TORQUE);
  gather.scalar(Feature::VISCOUS, ScalarIndicator::VISCOUS_FRICTION);
  gather.scalar(Feature::EFFICIENCY, ScalarIndicator::EFFICIENCY);
  gather.scalar(Feature::RESIDUAL, ScalarIndicator::RESIDUAL_RMS);
  gather.scalar(Feature::IMPULSES, ScalarIndicator::RESIDUAL_KURTOSIS);
  gather.scalar(Feature::IMPULSES, ScalarIndicator::RESIDUAL_CREST);
  gather.vector(Feature::ORDER_1, Line::WAVE_GENERATOR_1);
  gather.vector(Feature::ORDER_2, Line::WAVE_GENERATOR_2);
  gather.vector(Feature::ORDER_4, Line::WAVE_GENERATOR_4);
  gather.vector(Feature::ORDER_CIRCULAR_SPLINE, Line::CIRCULAR_SPLINE_2);
  gather.amplitude(Feature::CAGE, Line::CAGE);
  gather.amplitude(Feature::CAGE, Line::CAGE_LOBES);
  gather.amplitude(Feature::BALL, Line::BALL);
  gather.amplitude(Feature::BALL, Line::BALL_DOUBLE);
  gather.amplitude(Feature::OUTER, Line::OUTER);
  gather.amplitude(Feature::OUTER, Line::OUTER_BELOW);
  gather.amplitude(Feature::OUTER, Line::OUTER_ABOVE);
  gather.amplitude(Feature::INNER, Line::INNER);
  gather.amplitude(Feature::INNER, Line::INNER_BELOW);
  gather.amplitude(Feature::INNER, Line::INNER_ABOVE);
  gather.amplitude(Feature::TOOTH_PASS, Line::TOOTH_PASS);
  gather.amplitude(Feature::TOOTH_PASS, Line::TOOTH_PASS_ABOVE);
  return scores;
}

std::array<double, CAUSE_COUNT> causeProbabilities(const FeatureScores& scores) noexcept
{
  std::array<double, CAUSE_COUNT> logs{};
  double largest = -HUGE_VAL;
  for (std::size_t cause = 0; cause < CAUSE_COUNT; ++cause)
  {
    for (std::size_t feature = 0; feature < FEATURE_COUNT; ++feature)
    {
      if (scores[feature].compared)
      {
        const double score = std::clamp(scores[feature].score, -LARGEST_SCORE, LARGEST_SCORE);
        logs[cause] +=
            std::log(likelihood(score, expectedMove(static_cast<Cause>(cause), static_cast<Feature>(feature))));
      }
    }
    largest = std::max(largest, logs[cause]);
  }
  double sum = 0.0;
  for (double& value : logs)
  {
    value = std::exp(value - largest);
    sum += value;
  }
  for (double& value : logs)
  {
    value /= sum;
  }
  return logs;
}
}  // namespace hjt
