// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "harmonic_joint_twin/health/fault_signatures.hpp"

namespace hjt
{
constexpr double OTHER_MOTION = 1e-3;  // weight of a signature whose motion is not like the window's [-]

/// How far a signature's motion and the window's are alike, 0 ... 1.
inline double likeness(const MotionKind& motion, const OperatingPoint& point) noexcept
{
  constexpr double SPEED_RANGE = 0.2;      // difference of the speeds' logarithms up to which motions are alike
  constexpr double DIRECTION_RANGE = 0.3;  // difference of the directions up to which motions are alike
  if (!(motion.speed > 0.0 && point.speed > 0.0))
  {
    return 1.0;
  }
  const double speed = std::log(point.speed / motion.speed) / SPEED_RANGE;
  const double direction = (std::abs(point.direction) - motion.direction) / DIRECTION_RANGE;
  return std::exp(-0.5 * (speed * speed + direction * direction));
}

/// Signatures of the set, by cause, that make the pattern of the cause: those whose severity is nearest to 0.4.
std::array<std::vector<std::size_t>, CAUSE_COUNT> patternRows(const SignatureSet& set);

/// The numbers of a window that are compared with signatures.
class SignatureTerms
{
public:
  SignatureTerms(const SignatureSet& set, const WindowResidual& residual) noexcept;

  /// Natural logarithm of the likelihood, less a term that is equal for all signatures. `strength`: S of a cause
  /// without signature, beside the change. `alike`: likeness of the signature's motion and the window's, 0 ... 1.
  double logLikelihood(const SignatureParts& parts, double strength, double alike) const noexcept;

  /// Mean square of the window's differences less the signatures' changes, in spreads of a sound drive; 1 at least.
  double misfit(const SignatureParts& parts) const noexcept;

  using Direction = std::array<double, INDICATOR_COUNT>;

  /// Mean of the signatures' changes in their own spreads, each over its length, weighted by the likeness of its motion
  /// and the window's. Lines do not count.
  Direction direction(const std::vector<std::size_t>& rows, const OperatingPoint& point) const noexcept;

  /// The window's difference along a direction, over the spread of a sound drive in that direction. `instead`: a
  /// signature whose change takes the place of the difference.
  double along(const Direction& direction, const Signature* instead = nullptr) const noexcept;

  /// The largest score that a single change of the signature would have. Lines count only `with_lines`.
  double largest(const Signature& signature, bool with_lines, const Deviations& deviations) const noexcept;

private:
  using Causes = Eigen::Matrix<double, COMMON_CAUSES, 1>;
  using CausesSquare = Eigen::Matrix<double, COMMON_CAUSES, COMMON_CAUSES>;

  /// Difference of one indicator of a window from its reference.
  struct Term
  {
    double difference;
    double own;          // variance apart from the common causes
    Causes common;       // loadings on the common causes
    std::size_t number;  // of the signature
    std::size_t indicator;
    bool has_phase;      // one of two parts of a line
    double sound;        // value of the sound drive, that a share refers to
    double line_square;  // half the square of the sound line's amplitude, that of the sound lost motion; 0 of others
  };

  double shareOrChange(const Signature& signature, const Term& term) const noexcept;
  double changeBy(const Signature& signature, const Term& term) const noexcept;
  double changeBy(const SignatureParts& parts, const Term& term) const noexcept;
  void add(const WindowResidual& residual, std::size_t indicator, std::size_t number,
           std::optional<double> line_square = {}) noexcept;

  const SignatureSet& set_;
  const double freedom_;
  std::array<Term, INDICATOR_COUNT> terms_;
  std::size_t count_{};
};

using SeenFrom = std::array<double, CAUSE_COUNT>;  ///< severities by cause [-]

/// Least severity of each fault at which half of the drives with that fault would raise an alarm in the windows that
/// were compared last, among the severities of the signatures. Infinite: no severity would; NaN: the fault has no
/// signature. The function is for reports and allocates.
SeenFrom seenFrom(const Assessor& assessor, const OperatingPoint& point);
}  // namespace hjt
