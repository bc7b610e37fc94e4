// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "harmonic_joint_twin/health/fault_signatures.hpp"
#include "health/motion_likeness.hpp"

namespace hjt
{
namespace
{
using Causes = Eigen::Matrix<double, COMMON_CAUSES, 1>;
using CausesSquare = Eigen::Matrix<double, COMMON_CAUSES, COMMON_CAUSES>;

constexpr std::array UNKNOWN_STRENGTHS{ 3.0, 10.0, 30.0, 100.0 };  // S of what is in no table
constexpr double LARGE = 1e100;  // logarithms of products are taken before they overflow

/// One compared number of a window.
struct Term
{
  double difference;
  double own;
  Causes common;
  std::size_t number;  // of the signature
  bool has_phase;      // one of two parts of a line
  double sound;        // what a share is taken of
  double line_square;  // half the square of the sound line's amplitude, 0 of what has no phase
};

/// Half the square of the amplitude that a line with a phase has in the sound drive. Orders 2 and 1.98 are told apart
/// so little in a motion to and fro that they count as one.
double soundSquare(const WindowResidual& residual, LineSignal signal, std::size_t line) noexcept
{
  constexpr std::array NEIGHBOURS{ index(Line::WAVE_GENERATOR_2), index(Line::CIRCULAR_SPLINE_2) };
  const bool is_neighbour = line == NEIGHBOURS[0] || line == NEIGHBOURS[1];
  double square = 0.0;
  for (const std::size_t own : is_neighbour ? NEIGHBOURS : std::array{ line, line })
  {
    const double cosine = residual.sound[cosineIndex(signal, own)];
    const double sine = residual.sound[sineIndex(signal, own)];
    square += 0.5 * (cosine * cosine + sine * sine);
  }
  return is_neighbour ? square : 0.5 * square;
}

/// The numbers of a window that signatures speak of.
class Terms
{
public:
  Terms(const SignatureSet& set, const WindowResidual& residual) : set_(set), freedom_(residual.freedom)
  {
    for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
    {
      add(residual, i, i);
    }
    for (const LineSignal signal : ALL_LINE_SIGNALS)
    {
      for (std::size_t line = 0; line < LINE_COUNT && hasLine(signal, line); ++line)
      {
        const std::size_t number = signatureNumber(signal, line);
        if (isPhaseLocked(line))
        {
          const double square = soundSquare(residual, signal, line);
          add(residual, cosineIndex(signal, line), number, square);
          add(residual, sineIndex(signal, line), number, square);
        }
        else
        {
          add(residual, amplitudeIndex(signal, line), number);
        }
      }
    }
  }

  /// Natural logarithm, less what is the same for all. Without a signature the strength S is `strength`. `alike`: its
  /// motion and the window's, 0 ... 1.
  double logLikelihood(const Signature* signature, double strength, double alike) const noexcept
  {
    std::array<double, INDICATOR_COUNT> changes{};  // by the signature
    double widening = 1.0 + strength * strength;
    double of_lines = 0.0;
    if (signature != nullptr)
    {
      double square = 0.0;
      for (std::size_t i = 0; i < count_; ++i)
      {
        const Term& term = terms_[i];
        changes[i] = changeBy(*signature, term);
        square += (term.has_phase ? 0.5 : 1.0) * changes[i] * changes[i] / term.own;
      }
      widening = 1.0 + set_.length_error * set_.length_error * square;
      of_lines = set_.line_error * set_.line_error * signature->severity * signature->severity;
    }
    const double of_number =
        set_.number_error * set_.number_error + (1.0 - alike) * set_.motion_error * set_.motion_error;
    CausesSquare inner = CausesSquare::Identity();
    Causes projected = Causes::Zero();
    double square = 0.0;
    double log_determinant = 0.0;
    double product = 1.0;
    for (std::size_t i = 0; i < count_; ++i)
    {
      const Term& term = terms_[i];
      const double change = changes[i];
      const double mean = term.has_phase ? 0.0 : change;
      const double share = term.has_phase ? 0.5 : of_number;
      const double variance = term.own * widening + share * change * change + of_lines * term.line_square;
      const double difference = term.difference - mean;
      const Causes weighted = term.common / variance;
      inner.noalias() += weighted * term.common.transpose();
      projected += weighted * difference;
      square += difference * difference / variance;
      product *= variance / term.own;
      if (product > LARGE)
      {
        log_determinant += std::log(product);
        product = 1.0;
      }
    }
    log_determinant += std::log(product * inner.determinant());
    square -= projected.dot(inner.inverse() * projected);
    return -0.5 *
           (log_determinant + (freedom_ + static_cast<double>(count_)) * std::log1p(std::max(square, 0.0) / freedom_));
  }

private:
  double changeBy(const Signature& signature, const Term& term) const noexcept
  {
    const double change = signature.change[term.number];
    if (term.number >= SCALAR_COUNT)
    {
      return term.has_phase || change == 0.0 ? change : amplitudeChange(term.sound, change);
    }
    const auto scalar = static_cast<ScalarIndicator>(term.number);
    if (!isShare(signature.cause, scalar))
    {
      return change;
    }
    const double known = set_.sound[term.number];
    return isStiffness(scalar) && known > 0.0 ? change * term.sound * term.sound / known : change * term.sound;
  }

  void add(const WindowResidual& residual, std::size_t indicator, std::size_t number,
           std::optional<double> line_square = {}) noexcept
  {
    if (set_.fitted[number] && residual.own[indicator] > 0.0)
    {
      terms_[count_++] = { residual.difference[indicator],
                           residual.own[indicator],
                           Eigen::Map<const Causes>(residual.common[indicator].data()),
                           number,
                           line_square.has_value(),
                           residual.sound[indicator],
                           line_square.value_or(0.0) };
    }
  }

  const SignatureSet& set_;
  const double freedom_;
  std::array<Term, INDICATOR_COUNT> terms_;
  std::size_t count_{};
};
}  // namespace

void CauseSearch::Sum::add(double weighted, double prior, double severity) noexcept
{
  const double weight = prior * std::exp(weighted);
  priors += prior;
  total += weight;
  first += weight * severity;
  second += weight * severity * severity;
}

CauseSearch::CauseSearch(std::shared_ptr<const SignatureSet> set)
  : set_(std::move(set)), likelihoods_(set_->signatures.size() + UNKNOWN_STRENGTHS.size())
{
  start();
}

void CauseSearch::start() noexcept
{
  next_ = 0;
  largest_ = -std::numeric_limits<double>::infinity();
  sums_ = {};
}

void CauseSearch::advance(const WindowResidual& residual, const OperatingPoint& point, std::size_t count) noexcept
{
  const std::vector<Signature>& known = set_->signatures;
  const std::size_t rows = likelihoods_.size();
  const std::size_t end = std::min(next_ + count, signatures());
  if (next_ < rows)
  {
    const Terms terms(*set_, residual);
    for (; next_ < std::min(end, rows); ++next_)
    {
      likelihoods_[next_] = next_ < known.size() ?
                                terms.logLikelihood(&known[next_], 0.0, likeness(known[next_].motion, point)) :
                                terms.logLikelihood(nullptr, UNKNOWN_STRENGTHS[next_ - known.size()], 1.0);
      largest_ = std::max(largest_, likelihoods_[next_]);
    }
  }
  for (; next_ < end; ++next_)
  {
    const std::size_t row = next_ - rows;
    const double weighted = set_->evidence_weight * (likelihoods_[row] - largest_);
    if (row < known.size())
    {
      const Signature& signature = known[row];
      sums_[static_cast<std::size_t>(signature.cause)].add(weighted, OTHER_MOTION + likeness(signature.motion, point),
                                                           signature.severity);
    }
    else
    {
      sums_[static_cast<std::size_t>(Cause::NONE)].add(weighted, 1.0, 0.0);
    }
  }
}

CausePosterior CauseSearch::posterior() const noexcept
{
  CausePosterior posterior;
  double all = 0.0;
  for (std::size_t cause = 0; cause < CAUSE_COUNT; ++cause)
  {
    const Sum& sum = sums_[cause];
    if (sum.total > 0.0)
    {
      posterior.probability[cause] = sum.total / sum.priors;
      all += posterior.probability[cause];
      posterior.severity[cause] = sum.first / sum.total;
      const double mean = posterior.severity[cause];
      const double square = std::max(sum.second / sum.total - mean * mean, 0.0);
      posterior.severity_deviation[cause] =
          std::sqrt(square + set_->severity_error * set_->severity_error * mean * mean);
    }
  }
  for (double& probability : posterior.probability)
  {
    probability /= all;
  }
  return posterior;
}
}  // namespace hjt
