// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/health/fault_signatures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "health/indicator_table.hpp"
#include "health/signature_terms.hpp"

namespace hjt
{
namespace
{
constexpr std::array TOGETHER{
  causeOf(FaultKind::TOOTH_WEAR), causeOf(FaultKind::INTERFACE_WEAR), causeOf(FaultKind::LUBRICANT_DEGRADATION)
};                            // causes that grow together by use (docs/life.md)
constexpr double LESS = 0.4;  // severity of the second and third wear of a sum over that of the first wear [-]

/// Change of the indicators by a cause without signatures: unknown (strength S), a dragging brake, or noise of sensors.
struct Unknown
{
  double strength;  // S of an unknown change
  double drag;      // friction by a brake, equal at every speed, over the sound running torque
  double noise;     // share g by which the noise of the sensors grows

  double prior() const { return strength > 0.0 ? 1.0 : 0.1; }  // brakes and sensors fail less often than gears wear
};
constexpr std::array<Unknown, 12> UNKNOWNS{ { { 3.0, 0.0, 0.0 },
                                              { 10.0, 0.0, 0.0 },
                                              { 30.0, 0.0, 0.0 },
                                              { 100.0, 0.0, 0.0 },
                                              { 0.0, 0.05, 0.0 },
                                              { 0.0, 0.15, 0.0 },
                                              { 0.0, 0.4, 0.0 },
                                              { 0.0, 1.0, 0.0 },
                                              { 0.0, 0.0, 0.12 },
                                              { 0.0, 0.0, 0.25 },
                                              { 0.0, 0.0, 0.5 },
                                              { 0.0, 0.0, 1.0 } } };

/// Changes of the indicators by a dragging brake and by noise of the sensors, which increases the kinematic error.
Signature signatureOf(const Unknown& unknown, const WindowResidual& residual) noexcept
{
  constexpr std::size_t FRICTION = indexOf(ScalarIndicator::RUNNING_TORQUE);
  constexpr std::size_t PEAKS = indexOf(ScalarIndicator::KINEMATIC_ERROR);
  Signature signature{ Cause::NONE, 0.0, ANY_MOTION, {} };
  signature.change[FRICTION] = unknown.drag * residual.sound[FRICTION];
  signature.change[indexOf(ScalarIndicator::COULOMB_TORQUE)] = signature.change[FRICTION];
  signature.change[PEAKS] = unknown.noise * residual.sound[PEAKS];
  return signature;
}

double strengthOf(const Unknown& unknown) noexcept
{
  const double noise = 1.0 + unknown.noise;
  return std::sqrt(unknown.strength * unknown.strength + noise * noise - 1.0);
}
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
  const auto take = [&](Feature feature, std::size_t indicator, double score, double factor)
  {
    FeatureScore& best = scores[static_cast<std::size_t>(feature)];
    if (std::isfinite(score) && (!best.compared || std::abs(score) > std::abs(best.score)))
    {
      best = { score, factor, indicator, true };
    }
  };
  for (const ScalarRow& row : SCALARS)
  {
    const Deviation& deviation = deviations[indexOf(row.indicator)];
    take(row.feature, indexOf(row.indicator), deviation.score,
         deviation.score == 0.0 ? 0.0 : deviation.threshold_factor);
  }
  for (const LineRow& row : LINES)
  {
    const std::size_t line = index(row.line);
    for (const LineSignal signal : ALL_LINE_SIGNALS)
    {
      if (!hasLine(signal, line))
      {
        continue;
      }
      const std::size_t indicator = amplitudeIndex(signal, line);
      if (!isPhaseLocked(line))
      {
        // A fault only increases the amplitude of a line with a free phase, so a decrease is no evidence.
        const double score = std::max(deviations[indicator].score, 0.0);
        take(row.feature, indicator, score, score == 0.0 ? 0.0 : deviations[indicator].threshold_factor);
        continue;
      }
      // The square of the line's score is the sum of the squares of both parts' scores, minus 1. Noise of the two parts
      // then gives the mean square score of one indicator.
      const Deviation& cosine = deviations[cosineIndex(signal, line)];
      const Deviation& sine = deviations[sineIndex(signal, line)];
      const double square = cosine.score * cosine.score + sine.score * sine.score - 1.0;
      take(row.feature, indicator, std::sqrt(std::max(square, 0.0)),
           std::hypot(cosine.threshold_factor, sine.threshold_factor));
    }
  }
  return scores;
}

void CauseSearch::Sum::add(double weighted, double prior, double severity) noexcept
{
  const double weight = prior * std::exp(weighted);
  total += weight;
  first += weight * severity;
  second += weight * severity * severity;
}

/// Rows of the search: all single signatures, then all sums of two or three signatures that occur together.
std::vector<CauseSearch::Row> CauseSearch::rowsOf(const SignatureSet& set)
{
  std::vector<Row> rows;
  std::array<double, CAUSE_COUNT> alone{};
  std::array<double, CAUSE_COUNT> several{};
  for (const Signature& signature : set.signatures)
  {
    rows.push_back({ { &signature } });
    ++alone[static_cast<std::size_t>(signature.cause)];
  }
  const auto beside = [&](const Signature& first, Cause cause)
  {
    std::vector<const Signature*> found{ nullptr };
    for (const Signature& other : set.signatures)
    {
      const double share = other.severity / first.severity;
      const bool is_level = share == 1.0 || std::abs(share - LESS) < 0.05 * LESS;
      if (other.cause == cause && is_level && other.motion.speed == first.motion.speed &&
          other.motion.direction == first.motion.direction)
      {
        found.push_back(&other);
      }
    }
    return found;
  };
  for (const Signature& first : set.signatures)
  {
    const auto own = std::find(TOGETHER.begin(), TOGETHER.end(), first.cause) - TOGETHER.begin();
    if (own == static_cast<std::ptrdiff_t>(TOGETHER.size()))
    {
      continue;
    }
    const std::vector<const Signature*> thirds = beside(first, TOGETHER[(own + 2) % TOGETHER.size()]);
    for (const Signature* second : beside(first, TOGETHER[(own + 1) % TOGETHER.size()]))
    {
      for (const Signature* third : thirds)
      {
        if (second != nullptr || third != nullptr)
        {
          rows.push_back({ { &first, second, third } });
          ++several[static_cast<std::size_t>(first.cause)];
        }
      }
    }
  }
  for (auto row = rows.begin() + static_cast<std::ptrdiff_t>(set.signatures.size()); row != rows.end(); ++row)
  {
    const auto cause = static_cast<std::size_t>(row->parts.front()->cause);
    row->prior = alone[cause] / several[cause];
  }
  return rows;
}

CauseSearch::CauseSearch(std::shared_ptr<const SignatureSet> set)
  : set_(std::move(set))
  , rows_(rowsOf(*set_))
  , beforehand_(priorsOf(*set_))
  , likelihoods_(rows_.size() + UNKNOWNS.size())
{
  start();
}

/// Prior weights of the causes: one half in proportion to their rated occurrence, one half equal for all.
std::array<double, CAUSE_COUNT> CauseSearch::priorsOf(const SignatureSet& set)
{
  const std::array<double, CAUSE_COUNT>& rated = set.occurrence;
  const auto unrated = std::count(rated.begin(), rated.end(), 0.0);
  const double mean =
      std::accumulate(rated.begin(), rated.end(), 0.0) / static_cast<double>(std::ptrdiff_t{ CAUSE_COUNT } - unrated);
  std::array<double, CAUSE_COUNT> priors{};
  std::transform(rated.begin(), rated.end(), priors.begin(),
                 [mean](double rating) { return rating > 0.0 ? 0.5 * (1.0 + rating / mean) : 1.0; });
  return priors;
}

void CauseSearch::start() noexcept
{
  next_ = 0;
  misfit_ = 1.0;
  sums_ = {};
}

void CauseSearch::advance(const WindowResidual& residual, const OperatingPoint& point, std::size_t count) noexcept
{
  const std::size_t known = rows_.size();
  const std::size_t rows = likelihoods_.size();
  const std::size_t end = std::min(next_ + count, signatures());
  if (next_ < rows)
  {
    const SignatureTerms terms(*set_, residual);
    for (; next_ < std::min(end, rows); ++next_)
    {
      if (next_ < known)
      {
        const SignatureParts& parts = rows_[next_].parts;
        likelihoods_[next_] = terms.logLikelihood(parts, 0.0, likeness(parts.front()->motion, point));
        continue;
      }
      const Unknown& unknown = UNKNOWNS[next_ - known];
      const Signature signature = signatureOf(unknown, residual);
      likelihoods_[next_] = terms.logLikelihood({ &signature }, strengthOf(unknown), 1.0);
    }
    if (next_ == rows)
    {
      const auto unknown = likelihoods_.begin() + static_cast<std::ptrdiff_t>(known);
      const auto best = std::max_element(likelihoods_.begin(), unknown) - likelihoods_.begin();
      misfit_ = known == 0 ? 1.0 : terms.misfit(rows_[static_cast<std::size_t>(best)].parts);
      const double weight = set_->evidence_weight * (set_->misfit_weight + (1.0 - set_->misfit_weight) / misfit_);
      const double largest = *std::max_element(likelihoods_.begin(), likelihoods_.end());
      for (double& likelihood : likelihoods_)
      {
        likelihood = weight * (likelihood - largest);
      }
    }
  }
  for (; next_ < end; ++next_)
  {
    const std::size_t row = next_ - rows;
    if (row < known)
    {
      const Signature& first = *rows_[row].parts.front();
      const double prior = rows_[row].prior * (OTHER_MOTION + likeness(first.motion, point));
      Sum& sum = sums_[static_cast<std::size_t>(first.cause)];
      sum.add(likelihoods_[row], prior, first.severity);
      sum.priors += row < set_->signatures.size() ? prior : 0.0;  // combined signatures add to the prior of single ones
    }
    else
    {
      Sum& sum = sums_[static_cast<std::size_t>(Cause::NONE)];
      sum.add(likelihoods_[row], UNKNOWNS[row - known].prior(), 0.0);
      sum.priors += UNKNOWNS[row - known].prior();
    }
  }
}

CausePosterior CauseSearch::posterior() const noexcept
{
  CausePosterior posterior;
  double all = 0.0;
  const double by_misfit = set_->severity_misfit * (1.0 - 1.0 / misfit_);
  for (std::size_t cause = 0; cause < CAUSE_COUNT; ++cause)
  {
    const Sum& sum = sums_[cause];
    if (sum.total > 0.0)
    {
      posterior.probability[cause] = beforehand_[cause] * sum.total / sum.priors;
      all += posterior.probability[cause];
      posterior.severity[cause] = sum.first / sum.total;
      const double mean = posterior.severity[cause];
      const double square = std::max(sum.second / sum.total - mean * mean, 0.0);
      posterior.severity_deviation[cause] =
          std::sqrt(square + (set_->severity_error * set_->severity_error + by_misfit * by_misfit) * mean * mean);
    }
  }
  for (double& probability : posterior.probability)
  {
    probability /= all;
  }
  return posterior;
}

std::size_t patternCount(const SignatureSet& set) noexcept
{
  std::array<bool, CAUSE_COUNT> known{};
  for (const Signature& signature : set.signatures)
  {
    known[static_cast<std::size_t>(signature.cause)] = true;
  }
  return static_cast<std::size_t>(std::count(known.begin(), known.end(), true));
}

CausePatterns::CausePatterns(std::shared_ptr<const SignatureSet> set) : set_(std::move(set)), rows_(patternRows(*set_))
{
}

PatternScore CausePatterns::strongest(const WindowResidual& residual, const OperatingPoint& point) const noexcept
{
  const SignatureTerms terms(*set_, residual);
  PatternScore strongest;
  for (std::size_t cause = 0; cause < CAUSE_COUNT; ++cause)
  {
    if (const double student = terms.along(terms.direction(rows_[cause], point)); student > strongest.student)
    {
      strongest = { static_cast<Cause>(cause), student };
    }
  }
  return strongest;
}
}  // namespace hjt
