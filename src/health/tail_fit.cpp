// SPDX-License-Identifier: BSD-3-Clause
#include "health/tail_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "health/deviation_laws.hpp"
#include "health/reference_fit.hpp"

namespace hjt
{
namespace
{
constexpr double LEAST_OTHERS = 0.05;  // least share of a window's weight that the other windows determine
constexpr double TAIL_STEP = 0.01;     // 1 / degrees of freedom
// Least gain of the log likelihood over the normal distribution's: chance gives less in 95 %, half the
// quantile of chi square with one degree of freedom. Of so few windows the spread's own degrees of freedom say enough.
constexpr double LEAST_GAIN = 1.92;

/// Moments of a residual are no normal quantities, nor are amplitudes of lines whose phase is free: these have spreads
/// and a law of their own.
bool tellsTail(std::size_t indicator) noexcept
{
  return indicator != indexOf(ScalarIndicator::RESIDUAL_KURTOSIS) &&
         indicator != indexOf(ScalarIndicator::RESIDUAL_CREST) && !isFreeAmplitude(indicator);
}

/// Deviations of windows, each from all others in units of their spread, by logarithmic classes.
struct Residuals
{
  static constexpr std::size_t CLASSES = 48;
  static constexpr double LEAST = 0.1;
  static constexpr double PER_UNIT = 6.0;  // classes, of the natural logarithm

  void add(double off, double with_freedom) noexcept
  {
    const double place = PER_UNIT * std::log(std::max(std::abs(off) / LEAST, 1.0));
    counts[static_cast<std::size_t>(std::min(place, CLASSES - 1.0))] += 1.0;
    freedom += with_freedom;
    count += 1.0;
  }

  /// Logarithm, where single windows have this tail.
  double likelihood(double tail) const noexcept
  {
    const double inverse = tail + (1.0 + 3.0 * excessOf(tail)) * count / freedom;
    const double v = 1.0 / inverse;
    const double stretch = 1.0 / std::sqrt(1.0 - 2.0 * tail);
    double sum = count * (std::lgamma(0.5 * (v + 1.0)) - std::lgamma(0.5 * v) - 0.5 * std::log(v) + std::log(stretch));
    for (std::size_t i = 0; i < CLASSES; ++i)
    {
      const double off = stretch * LEAST * std::exp((static_cast<double>(i) + 0.5) / PER_UNIT);
      sum -= counts[i] * 0.5 * (v + 1.0) * std::log1p(off * off / v);
    }
    return sum;
  }

  std::array<double, CLASSES> counts{};
  double freedom{};
  double count{};
};
}  // namespace

void fitTails(ReferenceBin& bin, const LearnedSums& sums) noexcept
{
  const Eigen::SelfAdjointEigenSolver<Squares> axes(mapped(bin.information));
  const KeptWindows& kept = sums.kept;
  std::array<Residuals, TAILS> residuals;
  for (std::size_t window = 0; window < kept.count; ++window)
  {
    const PlaceVector place = mapped(kept.places[window]) - mapped(bin.mean_place);
    const PlaceVector along = (axes.eigenvectors().transpose() * place).array().square();
    for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
    {
      const Reference& reference = bin.references[i];
      const double freedom = bin.windows - 1.0 - reference.slopes_freedom;
      if (!tellsTail(i) || reference.count != bin.windows || !(reference.variance > 0.0) || freedom < 3.0)
      {
        continue;
      }
      const double off =
          static_cast<double>(kept.values[window][i]) - reference.mean - place.dot(mapped(reference.slopes));
      const double own =
          1.0 / bin.windows +
          (reference.fitted ? (along.array() / (axes.eigenvalues().array().max(0.0) + reference.ridge)).sum() : 0.0);
      const double square = off * off / std::max(1.0 - own, LEAST_OTHERS);
      const double others = (freedom * reference.variance - square) / (freedom - 1.0);
      if (others > 0.0)
      {
        residuals[tailOf(i)].add(std::sqrt(square / others), freedom - 1.0);
      }
    }
  }
  for (std::size_t kind = 0; kind < TAILS; ++kind)
  {
    bin.tail[kind] = 0.0;
    double most = residuals[kind].count > 0.0 ? residuals[kind].likelihood(0.0) + LEAST_GAIN : HUGE_VAL;
    for (double tail = TAIL_STEP; tail <= MOST_TAIL; tail += TAIL_STEP)
    {
      if (const double likelihood = residuals[kind].likelihood(tail); likelihood > most)
      {
        most = likelihood;
        bin.tail[kind] = tail;
      }
    }
  }
}
}  // namespace hjt
