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
constexpr double OTHER_MOTION = 1e-3;  // least weight of a signature by its motion, w_0 of CauseSearch [-]

/// Likeness of a signature's motion to the motion of a window, a of CauseSearch: 0 (unlike) to 1 (alike).
inline double likeness(const MotionKind& motion, const OperatingPoint& point) noexcept
{
  constexpr double SPEED_RANGE = 0.2;      // difference of ln(speed) between similar motions, N of CauseSearch [-]
  constexpr double DIRECTION_RANGE = 0.3;  // difference of direction between similar motions, Q of CauseSearch [-]
  if (!(motion.speed > 0.0 && point.speed > 0.0))
  {
    return 1.0;
  }
  const double speed = std::log(point.speed / motion.speed) / SPEED_RANGE;
  const double direction = (std::abs(point.direction) - motion.direction) / DIRECTION_RANGE;
  return std::exp(-0.5 * (speed * speed + direction * direction));
}

/// Indices, by cause, of the signatures that form the cause's pattern: those with the severity nearest to 0.4.
std::array<std::vector<std::size_t>, CAUSE_COUNT> patternRows(const SignatureSet& set);

/// Compares a window with signatures.
class SignatureTerms
{
public:
  SignatureTerms(const SignatureSet& set, const WindowResidual& residual) noexcept;

  /// Natural logarithm of the window's likelihood under `parts`, up to a constant. `strength`: S of an unknown change,
  /// 0 for a signature (CauseSearch). `alike`: likeness of the motions of signature and window, 0 ... 1.
  double logLikelihood(const SignatureParts& parts, double strength, double alike) const noexcept;

  /// Misfit f (CauseSearch): mean square of the window's difference minus the change by `parts`, in spreads; >= 1 [-].
  double misfit(const SignatureParts& parts) const noexcept;

  using Direction = std::array<double, INDICATOR_COUNT>;

  /// Pattern p of CausePatterns: mean of the normalised changes by the signatures `rows`, weighted by the likeness of
  /// the motions of signature and window, without lines.
  Direction direction(const std::vector<std::size_t>& rows, const OperatingPoint& point) const noexcept;

  /// Difference of the window along a direction, over the spread of a sound drive in this direction [-]. `instead`:
  /// signature whose change replaces the difference.
  double along(const Direction& direction, const Signature* instead = nullptr) const noexcept;

  /// Largest score of a single indicator if it changes as in the signature [-]. Lines count only if `with_lines`.
  double largest(const Signature& signature, bool with_lines, const Deviations& deviations) const noexcept;

private:
  using Causes = Eigen::Matrix<double, COMMON_CAUSES, 1>;
  using CausesSquare = Eigen::Matrix<double, COMMON_CAUSES, COMMON_CAUSES>;

  /// Difference of one indicator of a window from its reference.
  struct Term
  {
    double difference;
    double own;          // variance of the difference that common causes do not explain
    Causes common;       // loadings on the common causes
    std::size_t number;  // index in Signature::change
    std::size_t indicator;
    bool has_phase;      // whether the indicator is the cosine or sine part of a line
    double sound;        // indicator of the sound drive, of which a signature may state a share
    double line_square;  // A^2 / 2 of a sound line, square of the sound lost motion, 0 for others (CauseSearch)
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

/// Least severity of each fault, among those of the signatures, at which half of the drives with the fault would have
/// raised an alarm in the windows that were compared last. Infinite: no severity would; NaN: the fault has no
/// signature. The function is for reports and allocates.
SeenFrom seenFrom(const Assessor& assessor, const OperatingPoint& point);
}  // namespace hjt
