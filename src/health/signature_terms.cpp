// SPDX-License-Identifier: BSD-3-Clause
#include "health/signature_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace hjt
{
namespace
{
constexpr double LARGE = 1e100;  // product above which the function takes its logarithm, before it can overflow

/// Half the square of the amplitude of a phase-locked line in the sound drive. Orders 2 and 1.98 count as one line,
/// because a motion to and fro hardly separates these orders.
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
}  // namespace

std::array<std::vector<std::size_t>, CAUSE_COUNT> patternRows(const SignatureSet& set)
{
  constexpr double PATTERN_SEVERITY = 0.4;
  std::array<std::vector<std::size_t>, CAUSE_COUNT> rows;
  const std::vector<Signature>& known = set.signatures;
  const auto off = [](const Signature& signature) { return std::abs(std::log(signature.severity / PATTERN_SEVERITY)); };
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    std::vector<std::size_t>& own = rows[static_cast<std::size_t>(known[i].cause)];
    if (!own.empty() && off(known[i]) < off(known[own.front()]))
    {
      own.clear();
    }
    if (own.empty() || off(known[i]) == off(known[own.front()]))
    {
      own.push_back(i);
    }
  }
  return rows;
}

SignatureTerms::SignatureTerms(const SignatureSet& set, const WindowResidual& residual) noexcept
  : set_(set), freedom_(residual.freedom)
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

double SignatureTerms::logLikelihood(const SignatureParts& parts, double strength, double alike) const noexcept
{
  std::array<double, INDICATOR_COUNT> changes{};  // changes of the indicators by the signature
  for (std::size_t i = 0; i < count_; ++i)
  {
    changes[i] = changeBy(parts, terms_[i]);
  }
  const double widening = 1.0 + strength * strength;
  double severities = 0.0;  // sum of the squares of the severities
  for (const Signature* part : parts)
  {
    severities += part != nullptr ? part->severity * part->severity : 0.0;
  }
  const double of_lines = set_.line_error * set_.line_error * severities;
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

double SignatureTerms::misfit(const SignatureParts& parts) const noexcept
{
  CausesSquare inner = CausesSquare::Identity();
  Causes projected = Causes::Zero();
  double square = 0.0;
  for (std::size_t i = 0; i < count_; ++i)
  {
    const Term& term = terms_[i];
    const double left = term.difference - (term.has_phase ? 0.0 : changeBy(parts, term));
    const Causes weighted = term.common / term.own;
    inner.noalias() += weighted * term.common.transpose();
    projected += weighted * left;
    square += left * left / term.own;
  }
  square -= projected.dot(inner.inverse() * projected);
  return count_ > 0 ? std::max(1.0, square / static_cast<double>(count_)) : 1.0;
}

/// Change of an indicator by a signature, in the indicator's unit, before the transformation by amplitudeChange.
double SignatureTerms::shareOrChange(const Signature& signature, const Term& term) const noexcept
{
  const double change = signature.change[term.number];
  const auto scalar = static_cast<ScalarIndicator>(term.number);
  if (term.number >= SCALAR_COUNT || !isShare(signature.cause, scalar))
  {
    return change;
  }
  const double known = set_.sound[term.number];
  return isStiffness(scalar) && known > 0.0 ? change * term.sound * term.sound / known : change * term.sound;
}

double SignatureTerms::changeBy(const Signature& signature, const Term& term) const noexcept
{
  const double change = shareOrChange(signature, term);
  return term.number < SCALAR_COUNT || term.has_phase || change == 0.0 ? change : amplitudeChange(term.sound, change);
}

double SignatureTerms::changeBy(const SignatureParts& parts, const Term& term) const noexcept
{
  double change = 0.0;
  for (const Signature* part : parts)
  {
    change += part != nullptr ? changeBy(*part, term) : 0.0;
  }
  return change;
}

SignatureTerms::Direction SignatureTerms::direction(const std::vector<std::size_t>& rows,
                                                    const OperatingPoint& point) const noexcept
{
  Direction direction{};
  for (const std::size_t row : rows)
  {
    const Signature& signature = set_.signatures[row];
    Direction changes{};
    double square = 0.0;
    for (std::size_t i = 0; i < count_; ++i)
    {
      if (terms_[i].number < SCALAR_COUNT)
      {
        changes[i] = shareOrChange(signature, terms_[i]) / std::sqrt(terms_[i].own);
        square += changes[i] * changes[i];
      }
    }
    const double weight = (OTHER_MOTION + likeness(signature.motion, point)) / std::sqrt(square);
    for (std::size_t i = 0; i < count_ && square > 0.0; ++i)
    {
      direction[i] += weight * changes[i];
    }
  }
  return direction;
}

double SignatureTerms::largest(const Signature& signature, bool with_lines, const Deviations& deviations) const noexcept
{
  double largest = 0.0;
  for (std::size_t i = 0; i < count_; ++i)
  {
    const Term& term = terms_[i];
    if (term.number >= SCALAR_COUNT && !with_lines)
    {
      continue;
    }
    largest = std::max(largest, std::abs(deviations[term.indicator].scoreOf(changeBy(signature, term))));
  }
  return largest;
}

double SignatureTerms::along(const Direction& direction, const Signature* instead) const noexcept
{
  CausesSquare inner = CausesSquare::Identity();
  Causes of_direction = Causes::Zero();
  Causes of_difference = Causes::Zero();
  double square = 0.0;
  double product = 0.0;
  for (std::size_t i = 0; i < count_; ++i)
  {
    const Term& term = terms_[i];
    if (term.number < SCALAR_COUNT)
    {
      const double spread = std::sqrt(term.own);
      const Causes common = term.common / spread;
      inner.noalias() += common * common.transpose();
      of_direction += common * direction[i];
      const double difference = (instead != nullptr ? shareOrChange(*instead, term) : term.difference) / spread;
      of_difference += common * difference;
      square += direction[i] * direction[i];
      product += direction[i] * difference;
    }
  }
  const Causes left = inner.inverse() * of_direction;
  square -= left.dot(of_direction);
  return square > 0.0 ? (product - left.dot(of_difference)) / std::sqrt(square) : 0.0;
}

void SignatureTerms::add(const WindowResidual& residual, std::size_t indicator, std::size_t number,
                         std::optional<double> line_square) noexcept
{
  if (set_.fitted[number] && residual.own[indicator] > 0.0)
  {
    const double sound = residual.sound[indicator];
    const bool is_play = indicator == indexOf(ScalarIndicator::LOST_MOTION);
    terms_[count_++] = { residual.difference[indicator],
                         residual.own[indicator],
                         Eigen::Map<const Causes>(residual.common[indicator].data()),
                         number,
                         indicator,
                         line_square.has_value(),
                         sound,
                         line_square.value_or(is_play ? sound * sound : 0.0) };
  }
}

namespace
{
/// Least likeness of the motions at which a signature's lines count, because lines depend more on motion than on fault.
constexpr double ALIKE = 0.5;
}  // namespace

SeenFrom seenFrom(const Assessor& assessor, const OperatingPoint& point)
{
  const SignatureSet& set = assessor.signatures();
  const Baseline& baseline = assessor.baseline();
  const SignatureTerms terms(set, baseline.residual());
  const auto rows = patternRows(set);
  std::array<SignatureTerms::Direction, CAUSE_COUNT> directions;
  std::transform(rows.begin(), rows.end(), directions.begin(),
                 [&](const std::vector<std::size_t>& own) { return terms.direction(own, point); });

  /// Sums over the signatures of one cause and severity, weighted by likeness of the motions of signature and window.
  struct Mean
  {
    double weight{};
    double pattern{};  // Student's t of the pattern
    double single{};   // largest score of a single indicator
  };
  std::map<std::pair<std::size_t, double>, Mean> means;
  for (const Signature& signature : set.signatures)
  {
    const auto cause = static_cast<std::size_t>(signature.cause);
    const double alike = likeness(signature.motion, point);
    const double weight = OTHER_MOTION + alike;
    Mean& mean = means[{ cause, signature.severity }];
    mean.weight += weight;
    mean.pattern += weight * terms.along(directions[cause], &signature);
    mean.single += weight * terms.largest(signature, alike > ALIKE, assessor.deviations());
  }
  SeenFrom least;
  least.fill(std::numeric_limits<double>::quiet_NaN());
  for (const auto& [key, mean] : means)
  {
    double& from = least[key.first];
    from = std::isnan(from) ? HUGE_VAL : from;
    if (baseline.pattern(mean.pattern / mean.weight).score > baseline.patternThreshold() ||
        mean.single / mean.weight > baseline.threshold())
    {
      from = std::min(from, key.second);
    }
  }
  return least;
}
}  // namespace hjt
