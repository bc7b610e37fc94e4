// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
/// Largest tail (1 / degrees of freedom) of single windows. At a tail of 1/4 or more the error of a spread is infinite.
constexpr double MOST_TAIL = 0.22;

/// Converts Student's t with `freedom` degrees of freedom to a normal deviate (Wallace 1959). studentOf is the inverse.
double normalScore(double t, double freedom) noexcept;
double studentOf(double score, double freedom) noexcept;

/// Normal deviate that the share `share` of the normal distribution exceeds.
double normalQuantile(double share);

/// Repeatability that follows from indicators.least_spread. The shipped 0.01 gives friction the repeatability that was
/// measured on one UR5, 3 % and 0.22 N.m (docs/compare.md), and gives other indicators 1 %, which is assumed.
Repeatability repeatabilityOf(const Parameters& parameters);

/// Standard deviation of a sound drive's indicator from one recording to the next, in the unit of the indicator.
double repeatsWithin(const Repeatability& repeatability, const ReferenceBin& bin, std::size_t indicator) noexcept;

/// Persistence of an indicator's deviations from window to window.
struct Persistence
{
  double stays;        // share of the indicator's variance that persists, r of Baseline [-]
  double independent;  // share of the windows that count as independent, e of Baseline [-]
};

/// Share of the variance that persists from window to window, for all indicators of one kind (scalars or lines) in a
/// class: mean of the indicators' shares, and variance of the shares about this mean.
struct CommonPersistence
{
  double mean{};
  double variance{};  // without the part by the statistical errors of the single shares
  int count{};        // number of indicators
};

CommonPersistence commonPersistence(const ReferenceBin& bin, std::size_t kind) noexcept;

Persistence persistenceOf(const ReferenceBin& bin, const Reference& reference,
                          const CommonPersistence& common) noexcept;

/// Variance that a carried reference adds to the mean of `windows` windows, in the indicator's unit squared.
double carriedVariance(const ReferenceBin& bin, const CarriedError& error, std::size_t indicator,
                       double windows) noexcept;

/// x = (kurtosis - 3) / 6 of Student's t with 1/`tail` degrees of freedom. The squared error of a variance estimated
/// from windows with this distribution is (1 + 3 x) times that from normal windows. x is bounded, because at 4 degrees
/// of freedom or fewer it is not finite.
double excessOf(double tail) noexcept;

/// How the distribution of deviation / spread differs from the normal distribution (symbols of Baseline).
struct Uncertainty
{
  double inverse{};  // inverse degrees of freedom, 1 / v'
  double of_mean{};  // part of `inverse` by single windows, y^2 a / k

  double freedom() const noexcept;  ///< degrees of freedom v' [-]
  double stretch() const noexcept;  ///< factor g that makes deviation / spread a Student's t [-]
};

/// `learned`: share y of the variance that was estimated from windows; `tail`: inverse degrees of freedom a of a single
/// window; `weight`: number k of averaged windows; `freedom`: degrees of freedom v + v_0 of the estimate.
Uncertainty uncertaintyOf(double learned, double tail, double weight, double freedom) noexcept;

constexpr double LEAST_LEFT = 1e-4;  ///< least share of an indicator's variance left beside common causes [-]

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

/// Degrees of freedom of a variance by varianceOfAlike [-]. Smyth's estimate is 3.4 in seven references of 20 windows
/// in various motions, and 9 in a check-up.
constexpr double ALIKE_FREEDOM = 3.0;

/// Variance of each line, estimated from similar lines of the reference, in the line's unit squared. 0: not known.
///
/// Law:   s_0^2 = c_0^2 exp(mean(log(s^2 / c_0^2) + 1 / v + 1 / (3 v^2))), mean over at least four similar lines
/// where  s, v  spread and degrees of freedom of a line;  c_0  rms of its relativeErrors
/// Similar are the amplitudes of lines of one signal with a free phase, the parts of phase-locked lines of one signal,
/// and the parts of lines in proportion to the load.
/// Source: Smyth, Stat. Appl. Genet. Mol. Biol. 3 (2004), article 3, for log s^2 and the variance that follows. His
///         s_0^2, a geometric mean, is smaller, by 2 exp(psi(v_0 / 2)) / v_0 = 0.69 with v_0 = ALIKE_FREEDOM.
std::array<double, INDICATOR_COUNT> varianceOfAlike(const ReferenceBin& bin) noexcept;

/// Standard error of each line, divided by the least standard error among the lines of its signal in the window [-].
/// The quotient depends on the motion, not on the noise. 0: not known.
std::array<double, INDICATOR_COUNT> relativeErrors(const SignalIndicators& indicators) noexcept;

/// Adds a window to the sums of its class. `here`: covariates of the window. `model`: indicators of a model that were
/// subtracted from the window; null: none. The function does not allocate.
void learnWindow(ReferenceBin& bin, LearnedSums& sums, const SignalIndicators& indicators,
                 const SignalIndicators* model, const Place& here) noexcept;

/// Prior standard deviation of an indicator's change over half a class, as a share of the indicator [-]. Friction
/// changes most, in the shipped drive by 14 % for 5 K (threefold from 10 to 50 degC) and by 16 % for 12.6 N.m of load.
constexpr double SLOPE_SHARE = 0.2;

/// Fits the reference of a class to the sums over its windows: the regression on the covariates (Place), the tails, and
/// the common causes. `bin` is one of `bins`, and `all_sums` are their sums. The function does not allocate.
///
/// Ridge regression gives the slopes. The slopes over load and payload are common to all `bins` that differ only in
/// temperature, because a class has windows with few payloads. The common causes are the first principal components of
/// the residuals' correlations, for indicators that every window determined. At most COMMON_CAUSES count, with an
/// eigenvalue above the edge (1 + sqrt(p / n))^2 of p independent indicators in n windows (Marchenko and Pastur 1967).
///
/// Law:   b = (A + lambda)^-1 a,  d = tr((2 - (A + lambda)^-1 A) (A + lambda)^-1 A_own),
///        lambda = (s^2 + R^2) / (SLOPE_SHARE m)^2
/// where  A, a   sums of products of covariates, and of covariates and indicator, about their means. From other bins A
///               and a contain only what those bins' own slopes do not explain;  A_own  part of A by windows of `bin`
///        b, d   slopes, with normal prior of mean 0; degrees of freedom that they use (Hastie and Tibshirani,
///               Generalized Additive Models, 1990, section 3.5)
///        s      standard deviation of the indicator about the regression
///        m, R   Reference::scale (for a part of a line, that of the amplitude); repeatsWithin
/// With few windows, or for an indicator that is mostly noise, the slopes are small and use few degrees of freedom.
void fitReference(ReferenceBin& bin, const LearnedSums& sums, const std::vector<ReferenceBin>& bins,
                  const std::vector<LearnedSums>& all_sums, const Repeatability& repeatability, FitRoom& room) noexcept;
}  // namespace hjt
