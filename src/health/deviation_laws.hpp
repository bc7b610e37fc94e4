// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "harmonic_joint_twin/health/baseline.hpp"

namespace hjt
{
/// 1 / degrees of freedom of a window's own distribution, at most: from 4 down a spread tells nothing.
constexpr double MOST_TAIL = 0.22;

/// Student's t with `freedom` as a normal deviate (Wallace 1959), and back.
double normalScore(double t, double freedom) noexcept;
double studentOf(double score, double freedom) noexcept;

/// That so large a share lies beyond.
double normalQuantile(double share);

/// Repeatability of one UR5 from one recording to the next: 3 % and 0.22 N.m of its friction (docs/compare.md), which
/// are `share` 0.01 here; of other numbers nothing is measured, a third is assumed.
Repeatability repeatabilityOf(const Parameters& parameters);

/// Standard deviation of a sound drive's indicator from one recording to the next, unit of the indicator.
double repeatsWithin(const Repeatability& repeatability, const ReferenceBin& bin, std::size_t indicator) noexcept;

/// Share of the variance that stays from one window to the next.
struct Persistence
{
  double stays;        // r
  double independent;  // e
};

/// Of all indicators of a class of one kind, scalars or lines: what stays, mean, and what single ones differ from it
/// by.
struct CommonPersistence
{
  double mean{};
  double variance{};  // without the error of each
  int count{};
};

CommonPersistence commonPersistence(const ReferenceBin& bin, std::size_t kind) noexcept;

Persistence persistenceOf(const ReferenceBin& bin, const Reference& reference,
                          const CommonPersistence& common) noexcept;

/// Additional uncertainty of a reference carried to another motion, for a mean of so many windows.
double carriedVariance(const ReferenceBin& bin, const CarriedError& error, std::size_t indicator,
                       double windows) noexcept;

/// Kurtosis less 3, over 6, of Student's t with 1/`tail` degrees of freedom: by so much is a variance less well known
/// than from normal windows, 1 + 3 of it. Bounded: from 4 degrees of freedom down there is none.
double excessOf(double tail) noexcept;

/// Difference of the distribution of a deviation over its spread from the normal one.
struct Uncertainty
{
  double inverse{};  // 1 / v'
  double of_mean{};  // y^2 a / k

  double freedom() const noexcept;  ///< v' [-]
  double stretch() const noexcept;  ///< g, to Student's unit [-]
};

/// `learned`: share of the variance that is; `tail`: a; `weight`: k; `freedom`: that the learned spread has.
Uncertainty uncertaintyOf(double learned, double tail, double weight, double freedom) noexcept;

/// Of several; of none that of one degree of freedom.
struct MeanUncertainty
{
  void add(const Uncertainty& one) noexcept;
  Uncertainty mean() const noexcept;

  double count{};
  Uncertainty sum;
};
}  // namespace hjt
