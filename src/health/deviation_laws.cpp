// SPDX-License-Identifier: BSD-3-Clause
#include "health/deviation_laws.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>

#include "gear/ratio.hpp"
#include "health/indicator_table.hpp"

namespace hjt
{
namespace
{
constexpr double CARRIED_WINDOWS = 10.0;  // of the means that CarriedError is fitted to
constexpr double LEAST_INVERSE = 1e-6;    // of degrees of freedom: beyond a million it is the normal distribution
constexpr int MIN_COMMON = 4;             // indicators before what they have in common means anything

// Of the friction, over Repeatability::share.
constexpr double FRICTION_SHARE = 3.0;    // [-]
constexpr double FRICTION_TORQUE = 22.0;  // at the joint [N.m]

/// What the drive differs from the model by: of a line the root of the sum of squares over the lines of its signal
/// whose phase stays, for resonances make any of them large in one motion and small in another.
double sizeOffModel(const ReferenceBin& bin, std::size_t indicator) noexcept
{
  if (indicator < SCALAR_COUNT)
  {
    return std::abs(bin.references[indicator].mean);
  }
  double square = 0.0;
  for (std::size_t line = 0; line < FIRST_LOCKED; ++line)
  {
    const double amplitude = bin.references[amplitudeIndex(signalOf(indicator), line)].mean;
    square += amplitude * amplitude;
  }
  return std::sqrt(square);
}

/// Standard error of what is found to stay (von Neumann 1941).
double errorOfStay(const ReferenceBin& bin, const Reference& reference) noexcept
{
  return 1.0 / std::sqrt(std::max(reference.count - bin.runs, 1));
}
}  // namespace

double normalScore(double t, double freedom) noexcept
{
  return std::copysign(std::sqrt(freedom * std::log1p(t * t / freedom)), t) * (8.0 * freedom + 1.0) /
         (8.0 * freedom + 3.0);
}

double studentOf(double score, double freedom) noexcept
{
  const double plain = score * (8.0 * freedom + 3.0) / (8.0 * freedom + 1.0);
  return std::sqrt(freedom * std::expm1(plain * plain / freedom));
}

double normalQuantile(double share)
{
  return boost::math::quantile(boost::math::complement(boost::math::normal(), share));
}

Repeatability repeatabilityOf(const Parameters& parameters)
{
  const double share = parameters.indicators.least_spread;
  return { share, FRICTION_SHARE * share, FRICTION_TORQUE * share / nominalRatio(parameters.gear) };
}

double repeatsWithin(const Repeatability& repeatability, const ReferenceBin& bin, std::size_t indicator) noexcept
{
  const double own = bin.references[amplitudeOf(indicator)].scale;  // of a part of a line: it may be near zero itself
  const auto friction = [&](double torque)
  { return std::hypot(repeatability.friction_share * torque, repeatability.friction_torque); };
  switch (static_cast<ScalarIndicator>(indicator))
  {
    case ScalarIndicator::RUNNING_TORQUE:
    case ScalarIndicator::COULOMB_TORQUE:
      return friction(own);
    case ScalarIndicator::LOAD_FRICTION:
      return repeatability.friction_share * own;
    case ScalarIndicator::VISCOUS_FRICTION:
    {
      const double speed = std::exp2(bin.bin.speed + 0.5);  // middle of the octave [rad/s]
      return friction(bin.references[indexOf(ScalarIndicator::RUNNING_TORQUE)].scale) / speed;
    }
    default:
      return repeatability.share * own;
  }
}

CommonPersistence commonPersistence(const ReferenceBin& bin, std::size_t kind) noexcept
{
  CommonPersistence common;
  double sum = 0.0;
  double square = 0.0;
  double errors = 0.0;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const Reference& reference = bin.references[i];
    if (tailOf(i) == kind && reference.within > 0.0 && reference.variance > 0.0)
    {
      const double found = 1.0 - reference.within / reference.variance;
      const double error = errorOfStay(bin, reference);
      sum += found;
      square += found * found;
      errors += error * error;
      ++common.count;
    }
  }
  if (common.count >= MIN_COMMON)
  {
    common.mean = sum / common.count;
    common.variance = std::max((square - sum * common.mean) / (common.count - 1) - errors / common.count, 0.0);
  }
  return common;
}

Persistence persistenceOf(const ReferenceBin& bin, const Reference& reference, const CommonPersistence& common) noexcept
{
  if (!(reference.within > 0.0 && reference.variance > 0.0))
  {
    return { 1.0, 1.0 };
  }
  double stays = 1.0 - reference.within / reference.variance;
  double error = errorOfStay(bin, reference);
  if (common.count >= MIN_COMMON)
  {
    const double all = common.variance + error * error;
    const double own = common.variance / all;
    stays = common.mean + own * (stays - common.mean);
    error = std::sqrt(own * error * error + (1.0 - own) * (1.0 - own) * all / common.count);
  }
  // What is not seen to stay may, and what seems to may not.
  const double least = std::clamp(stays - error, 0.0, 1.0);
  const double runs = static_cast<double>(bin.runs) / bin.windows;
  return { std::clamp(stays + error, 0.0, 1.0), std::max((1.0 - least) / (1.0 + least), std::min(runs, 1.0)) };
}

double carriedVariance(const ReferenceBin& bin, const CarriedError& error, std::size_t indicator,
                       double windows) noexcept
{
  const double off = error.share * sizeOffModel(bin, indicator);
  // Below CARRIED_WINDOWS as if all of it were noise.
  return (error.deviation * error.deviation + off * off) * std::max(CARRIED_WINDOWS / windows, 1.0);
}

double excessOf(double tail) noexcept
{
  return tail / (1.0 - 4.0 * std::min(tail, MOST_TAIL));
}

double Uncertainty::freedom() const noexcept
{
  return 1.0 / std::clamp(inverse, LEAST_INVERSE, 1.0);
}

double Uncertainty::stretch() const noexcept
{
  return 1.0 / std::sqrt(1.0 - 2.0 * of_mean);
}

Uncertainty uncertaintyOf(double learned, double tail, double weight, double freedom) noexcept
{
  const double of_mean = learned * learned * tail / weight;
  return { learned * learned * (1.0 + 3.0 * excessOf(tail)) / freedom + of_mean, of_mean };
}

void MeanUncertainty::add(const Uncertainty& one) noexcept
{
  ++count;
  sum.inverse += one.inverse;
  sum.of_mean += one.of_mean;
}

Uncertainty MeanUncertainty::mean() const noexcept
{
  return count > 0.0 ? Uncertainty{ sum.inverse / count, sum.of_mean / count } : Uncertainty{ 1.0, 0.0 };
}
}  // namespace hjt
