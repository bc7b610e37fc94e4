// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
/// 1 / degrees of freedom of a window's own distribution, at most: from 4 down a spread tells nothing.
constexpr double MOST_TAIL = 0.22;

/// Student's t with `freedom` as a normal deviate (Wallace 1959), and back.
double normalScore(double t, double freedom) noexcept;
double studentOf(double score, double freedom) noexcept;

/// Normal deviate beyond which this share of the distribution lies.
double normalQuantile(double share);

/// Repeatability of one UR5 from one recording to the next: 3 % and 0.22 N.m of its friction (docs/compare.md), which
/// corresponds to a `share` of 0.01. For other indicators nothing is measured, and a third of it is assumed.
Repeatability repeatabilityOf(const Parameters& parameters);

/// Standard deviation of a sound drive's indicator from one recording to the next, in the unit of the indicator.
double repeatsWithin(const Repeatability& repeatability, const ReferenceBin& bin, std::size_t indicator) noexcept;

/// Share of the variance that stays from one window to the next.
struct Persistence
{
  double stays;        // r
  double independent;  // e
};

/// Persistence of all indicators of one kind, scalars or lines, in a class: mean of the share that stays, and variance
/// of single indicators about that mean.
struct CommonPersistence
{
  double mean{};
  double variance{};  // variance without the statistical error of each indicator
  int count{};
};

CommonPersistence commonPersistence(const ReferenceBin& bin, std::size_t kind) noexcept;

Persistence persistenceOf(const ReferenceBin& bin, const Reference& reference,
                          const CommonPersistence& common) noexcept;

/// Additional variance of a mean of windows, if its reference was learned in another motion.
double carriedVariance(const ReferenceBin& bin, const CarriedError& error, std::size_t indicator,
                       double windows) noexcept;

/// Kurtosis less 3, over 6, of Student's t with 1/`tail` degrees of freedom. A variance from such windows has 1 + 3
/// times this the uncertainty of one from normal windows. The value is bounded: below 4 degrees of freedom it does not
/// exist.
double excessOf(double tail) noexcept;

/// How the distribution of a deviation over its spread differs from the normal distribution.
struct Uncertainty
{
  double inverse{};  // 1 / v'
  double of_mean{};  // y^2 a / k

  double freedom() const noexcept;  ///< v' [-]
  double stretch() const noexcept;  ///< g, to Student's unit [-]
};

/// `learned`: share of the variance that was learned; `tail`: a; `weight`: k; `freedom`: degrees of freedom of the
/// learned spread.
Uncertainty uncertaintyOf(double learned, double tail, double weight, double freedom) noexcept;

constexpr double LEAST_LEFT = 1e-4;  ///< least share of a variance that the common causes leave [-]

using Squares = Eigen::Matrix<double, PLACES, PLACES, Eigen::RowMajor>;
using PlaceVector = Eigen::Matrix<double, PLACES, 1>;

inline Eigen::Map<const Squares> mapped(const PlaceSquares& squares) noexcept
{
  return Eigen::Map<const Squares>(squares.front().data());
}
inline Eigen::Map<Squares> mapped(PlaceSquares& squares) noexcept
{
  return Eigen::Map<Squares>(squares.front().data());
}
inline Eigen::Map<const PlaceVector> mapped(const Place& place) noexcept
{
  return Eigen::Map<const PlaceVector>(place.data());
}
inline Eigen::Map<PlaceVector> mapped(Place& place) noexcept
{
  return Eigen::Map<PlaceVector>(place.data());
}

/// Degrees of freedom that varianceOfAlike counts as, beside a line's own: by Smyth's estimate 3.4 in seven references
/// of 20 windows in motions of one's own, 9 in a check-up [-].
constexpr double ALIKE_FREEDOM = 3.0;

/// Variance of each line as lines like it have it in this reference, unit of the indicator squared. 0: not known.
///
/// Law:   s_0^2 = c_0^2 exp(mean(log(s^2 / c_0^2) + 1 / v + 1 / (3 v^2))), over the lines alike, four at least
/// where  s, v  spread and degrees of freedom of a line;  c_0  its relativeErrors, rms;  alike: of one signal the
///        amplitudes of lines whose phase is free, or the parts of those whose phase stays, or those of the ripple in
///        proportion to the load
/// Source: Smyth, Stat. Appl. Genet. Mol. Biol. 3 (2004), article 3, for log s^2 and the variance that follows. His
///         s_0^2 is 0.69 of this one, a geometric mean, with ALIKE_FREEDOM: 2 exp(psi(v_0 / 2)) / v_0.
std::array<double, INDICATOR_COUNT> varianceOfAlike(const ReferenceBin& bin) noexcept;

/// Standard error of each line, divided by the least standard error of its signal's lines in the same window [-]. The
/// quotient depends on the motion, not on the noise. 0: not known.
std::array<double, INDICATOR_COUNT> relativeErrors(const SignalIndicators& indicators) noexcept;

/// Adds a window to the sums of its class. `here`: place of the window in the class. `model`: indicators that were
/// subtracted; nullptr: none. Does not allocate.
void learnWindow(ReferenceBin& bin, LearnedSums& sums, const SignalIndicators& indicators,
                 const SignalIndicators* model, const Place& here) noexcept;

/// Prior standard deviation of the change of an indicator over half a class, as a share of the indicator [-]. Of a
/// sound drive the friction changes most: that of the shipped drive by 14 % in 5 K (threefold from 10 to 50 degC) and
/// by 16 % with 12.6 N.m.
constexpr double SLOPE_SHARE = 0.2;

/// Makes of the sums what windows are compared with: the straight line over the place, and of what it leaves the first
/// principal components of the correlations, as many as stand out of noise, COMMON_CAUSES at most: eigenvalue above the
/// edge (1 + sqrt(p / n))^2 of p independent indicators in n windows (Marchenko and Pastur 1967). Slopes over load and
/// payload are those of all of `bins` that differ from this one, one of them, in temperature at most: a class sees few
/// payloads. Components of the indicators that every window determined. `all_sums`: by `bins`. Does not allocate.
///
/// Law:   b = (A + lambda)^-1 a,  d = tr((2 - (A + lambda)^-1 A) (A + lambda)^-1 A_own),
///        lambda = (s^2 + R^2) / (SLOPE_SHARE m)^2
/// where  A, a  products of the places, and of places and indicator, from their means, less what in other bins goes
///              with the slopes that each has of its own;  A_own  of this bin's windows
///        d     what the squares left fall short by where there are no slopes, in s^2 (Hastie and Tibshirani,
///              Generalized Additive Models, 1990, section 3.5)
///        b, s  slopes, drawn beforehand from a normal distribution of SLOPE_SHARE m; spread they leave
///        m, R  Reference::scale, of a part of a line its amplitude's; repeatsWithin
/// So few windows, or an indicator that is mostly noise, have small slopes that take few degrees of freedom.
/// ReferenceBin::tail by fitTails.
void fitReference(ReferenceBin& bin, const LearnedSums& sums, const std::vector<ReferenceBin>& bins,
                  const std::vector<LearnedSums>& all_sums, const Repeatability& repeatability, FitRoom& room) noexcept;
}  // namespace hjt
