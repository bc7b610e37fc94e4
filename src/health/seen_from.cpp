// SPDX-License-Identifier: BSD-3-Clause
#include "health/seen_from.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "health/motion_likeness.hpp"
#include "health/signature_terms.hpp"

namespace hjt
{
namespace
{
/// Likeness of the motions from which on a signature tells of lines, which depend on the motion more than on the fault.
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

  /// Over the signatures of one cause and severity, by how far their motion is like the window's.
  struct Mean
  {
    double weight{};
    double pattern{};  // Student's t
    double single{};   // score of the indicator furthest off
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
    mean.single += weight * terms.largest(signature, alike > ALIKE, baseline, assessor.deviations());
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
