// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// What may be wrong with the drive: the kinds of faults, in their order from FIRST_FAULT on, and a damaged tooth of
/// the circular spline.
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

const char* featureName(Feature feature) noexcept;  ///< "lost_motion"

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

/// Where a cause drives the features: a direction in the space of their compressed scores.
struct Signature
{
  /// A direction with more or fewer numbers than there are features does not compile.
  template <std::size_t COUNT>
  Signature(Cause whose, const double (&numbers)[COUNT]) : cause(whose)
  {
    static_assert(COUNT == FEATURE_COUNT, "a number for each Feature: run scripts/evaluate_health --fit");
    std::copy(std::begin(numbers), std::end(numbers), direction.begin());
  }

  Cause cause;
  std::array<double, FEATURE_COUNT> direction{};
};

/// The table of docs/indicators.md, fitted to the model's own faults by `scripts/evaluate_health --fit`.
const std::vector<Signature>& faultSignatures() noexcept;

/// Probabilities of the causes given the scores; NONE is excluded, 0. Equal if no feature carries information.
///
/// Law:   P(c | s) ~ exp(k max cos(y, d)),  over the signatures d of the cause, of different motions
/// where  y   asinh of the noise-corrected scores, over the features present in both vectors
///        k   sharpness, assumed: P ranks the causes, it is no frequency
std::array<double, CAUSE_COUNT> causeProbabilities(const FeatureScores& scores) noexcept;
}  // namespace hjt
