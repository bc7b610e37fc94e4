// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// What may be wrong with the drive: the kinds of faults, in their order from FIRST_FAULT on, and a damaged tooth of the
/// circular spline.
enum class Cause : std::uint8_t
{
  NONE,
  FIRST_FAULT,
  CIRCULAR_SPLINE_TOOTH = FIRST_FAULT + FAULT_KINDS,
  COUNT
};
constexpr auto CAUSE_COUNT = static_cast<std::size_t>(Cause::COUNT);

constexpr Cause causeOf(FaultKind kind)
{
  return static_cast<Cause>(static_cast<std::size_t>(Cause::FIRST_FAULT) + static_cast<std::size_t>(kind));
}

const char* causeName(Cause cause) noexcept;  ///< "tooth_root_crack"

/// Groups of indicators that say the same: the cause is sought among these.
enum class Feature : std::size_t
{
  RATIO,
  KINEMATIC_ERROR,
  STIFFNESS,
  LOST_MOTION,
  LOOP_AREA,
  RUNNING_TORQUE,
  COULOMB,
  VISCOUS,
  EFFICIENCY,
  RESIDUAL,
  IMPULSES,  ///< kurtosis and crest of the residual
  ORDER_1,
  ORDER_2,
  ORDER_4,
  ORDER_CIRCULAR_SPLINE,
  CAGE,
  BALL,
  OUTER,
  INNER,
  TOOTH_PASS,
  COUNT
};
constexpr auto FEATURE_COUNT = static_cast<std::size_t>(Feature::COUNT);

/// The strongest of a group's deviations.
struct FeatureScore
{
  double score{};             ///< signed; of a line with a phase the length of its change, > 0; 0: not compared
  double threshold_factor{};  ///< as in Deviation
  std::size_t indicator{};    ///< whose
  bool compared{};
};
using FeatureScores = std::array<FeatureScore, FEATURE_COUNT>;

FeatureScores featureScores(const Deviations& deviations) noexcept;

/// How a feature moves under a cause.
enum class Move : std::uint8_t
{
  STILL,
  UP,
  DOWN,
  ANY  ///< may move either way, or not
};

/// The table of docs/indicators.md.
Move expectedMove(Cause cause, Feature feature) noexcept;

/// Probabilities of the causes, NONE included, given the scores: naive Bayes, equal priors.
///
/// Law:   P(c | s) ~ product over the compared features of p(s_f | move of f under c)
/// where  still  0.95 N(0, 1.5) + 0.05 N(0, 8)
///        up     0.2 still + 0.8 N(+8, 4),   down  0.2 still + 0.8 N(-8, 4)
///        any    0.5 still + 0.5 N(0, 8)
/// Scores count as 12 at most.
std::array<double, CAUSE_COUNT> causeProbabilities(const FeatureScores& scores) noexcept;
}  // namespace hjt
