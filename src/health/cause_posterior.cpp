// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "harmonic_joint_twin/health/fault_signatures.hpp"
#include "health/motion_likeness.hpp"
#include "health/signature_terms.hpp"

namespace hjt
{
namespace
{
constexpr std::array UNKNOWN_STRENGTHS{ 3.0, 10.0, 30.0, 100.0 };  // S of what is in no table
constexpr double MISFIT_WEIGHT = 0.2;    // w_1: share of the evidence's weight that is left where no signature fits
constexpr double MISFIT_SEVERITY = 0.5;  // share of the severity there: other drives soften up to three times as much
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
  misfit_ = 1.0;
  sums_ = {};
}

void CauseSearch::advance(const WindowResidual& residual, const OperatingPoint& point, std::size_t count) noexcept
{
  const std::vector<Signature>& known = set_->signatures;
  const std::size_t rows = likelihoods_.size();
  const std::size_t end = std::min(next_ + count, signatures());
  if (next_ < rows)
  {
    const SignatureTerms terms(*set_, residual);
    for (; next_ < std::min(end, rows); ++next_)
    {
      likelihoods_[next_] = next_ < known.size() ?
                                terms.logLikelihood(&known[next_], 0.0, likeness(known[next_].motion, point)) :
                                terms.logLikelihood(nullptr, UNKNOWN_STRENGTHS[next_ - known.size()], 1.0);
    }
    if (next_ == rows)
    {
      const auto unknown = likelihoods_.begin() + static_cast<std::ptrdiff_t>(known.size());
      const auto best = std::max_element(likelihoods_.begin(), unknown) - likelihoods_.begin();
      misfit_ = known.empty() ? 1.0 : terms.misfit(known[static_cast<std::size_t>(best)]);
      const double weight = set_->evidence_weight * (MISFIT_WEIGHT + (1.0 - MISFIT_WEIGHT) / misfit_);
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
    if (row < known.size())
    {
      const Signature& signature = known[row];
      sums_[static_cast<std::size_t>(signature.cause)].add(
          likelihoods_[row], OTHER_MOTION + likeness(signature.motion, point), signature.severity);
    }
    else
    {
      sums_[static_cast<std::size_t>(Cause::NONE)].add(likelihoods_[row], 1.0, 0.0);
    }
  }
}

CausePosterior CauseSearch::posterior() const noexcept
{
  CausePosterior posterior;
  double all = 0.0;
  const double by_misfit = MISFIT_SEVERITY * (1.0 - 1.0 / misfit_);
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
