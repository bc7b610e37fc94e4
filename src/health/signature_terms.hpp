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
constexpr double OTHER_MOTION = 1e-3;  // weight of a signature of no motion alike

/// How far a signature's motion and the window's are alike, 0 ... 1.
inline double likeness(const MotionKind& motion, const OperatingPoint& point) noexcept
{
  constexpr double SPEED_RANGE = 0.2;      // of the logarithm, in which motions are alike
  constexpr double DIRECTION_RANGE = 0.3;  // as well
  if (!(motion.speed > 0.0 && point.speed > 0.0))
  {
    return 1.0;
  }
  const double speed = std::log(point.speed / motion.speed) / SPEED_RANGE;
  const double direction = (std::abs(point.direction) - motion.direction) / DIRECTION_RANGE;
  return std::exp(-0.5 * (speed * speed + direction * direction));
}

/// Rows of the set that make each cause's pattern: those whose severity is nearest to 0.4.
std::array<std::vector<std::size_t>, CAUSE_COUNT> patternRows(const SignatureSet& set);

/// The numbers of a window that signatures speak of.
class SignatureTerms
{
public:
  SignatureTerms(const SignatureSet& set, const WindowResidual& residual) noexcept;

  /// Natural logarithm, less what is the same for all. `strength`: S of what is in no table, beside the change.
  /// `alike`: their motion and the window's, 0 ... 1.
  double logLikelihood(const SignatureParts& parts, double strength, double alike) const noexcept;

  /// Mean square of what the signatures leave of the differences, in a sound drive's spreads; 1 at least.
  double misfit(const SignatureParts& parts) const noexcept;

  using Direction = std::array<double, INDICATOR_COUNT>;

  /// Mean of the signatures' changes in own spreads, each over its length, by how far its motion is like the window's.
  /// Lines are left out.
  Direction direction(const std::vector<std::size_t>& rows, const OperatingPoint& point) const noexcept;

  /// The difference along a direction over the spread that a sound drive has there; `instead`: that signature's change
  /// in place of the difference.
  double along(const Direction& direction, const Signature* instead = nullptr) const noexcept;

  /// Of the signature's changes the largest score by itself; of those of lines only `with_lines`.
  double largest(const Signature& signature, bool with_lines, const Baseline& baseline,
                 const Deviations& deviations) const noexcept;

private:
  using Causes = Eigen::Matrix<double, COMMON_CAUSES, 1>;
  using CausesSquare = Eigen::Matrix<double, COMMON_CAUSES, COMMON_CAUSES>;

  /// One compared number of a window.
  struct Term
  {
    double difference;
    double own;
    Causes common;
    std::size_t number;  // of the signature
    std::size_t indicator;
    bool has_phase;      // one of two parts of a line
    double sound;        // value that a share refers to
    double line_square;  // half the square of the sound line's amplitude, that of the sound lost motion; 0 of others
  };

  void addDirection(const Signature& signature, double weight, Direction& direction) const noexcept;
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

/// Least severity at which half of the drives with each fault would be out of the ordinary in the windows that were
/// compared last, among those of the signatures; infinite: with none; NaN: the fault has no signature. For reports:
/// allocates.
SeenFrom seenFrom(const Assessor& assessor, const OperatingPoint& point);
}  // namespace hjt
