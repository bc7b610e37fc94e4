// SPDX-License-Identifier: BSD-3-Clause
#include "life/remaining_life.hpp"

#include <algorithm>
#include <cmath>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>

namespace hjt
{
namespace
{
enum Nature
{
  FLANK,
  INTERFACE,
  BEARING_LIFE,
  SPALL_GROWTH,
  STRENGTH,
  NATURES
};

/// Hours until the use ahead has grown by `left`, of what `of` takes from a usage.
template <class Of>
double hoursUntil(const FutureLoad& future_load, double left, Of&& of)
{
  if (left <= 0.0)
  {
    return 0.0;
  }
  const auto after = std::lower_bound(future_load.usage.begin() + 1, future_load.usage.end() - 1, left,
                                      [&](const Usage& usage, double value) { return of(usage) < value; });
  const auto before = after - 1;
  const double stretch = of(*after) - of(*before);
  const auto begin = static_cast<double>(before - future_load.usage.begin());
  return stretch > 0.0 ? future_load.step * (begin + (left - of(*before)) / stretch) : HUGE_VAL;
}

double squared(double value)
{
  return value * value;
}
}  // namespace

RemainingLife::RemainingLife(const LifeParameters& parameters, int particles, std::uint32_t seed)
  : parameters_(parameters)
  , random_(seed)
  , particles_(static_cast<std::size_t>(particles))
  , weights_(particles_.size(), 1.0 / static_cast<double>(particles))
  , drawn_(particles_.size())
  , ends_(particles_.size())
{
  const BearingLife bearing(parameters);
  for (Particle& particle : particles_)
  {
    const UnitVariation variation = drawVariation(parameters, bearing, random_);
    particle.variation = { std::log(variation.flank_factor), std::log(variation.interface_factor),
                           std::log(variation.bearing_life), std::log(variation.spall_growth),
                           std::log(variation.strength) };
    particle.flank_wear = 0.0;
    particle.interface_wear = 0.0;
  }
}

UnitVariation RemainingLife::variationOf(const Particle& particle) noexcept
{
  return { std::exp(particle.variation[FLANK]), std::exp(particle.variation[INTERFACE]),
           std::exp(particle.variation[BEARING_LIFE]), std::exp(particle.variation[SPALL_GROWTH]),
           std::exp(particle.variation[STRENGTH]) };
}

/// Miner's sum of a place of a flexspline by a use.
double RemainingLife::fatigueBy(const Usage& usage, double log_strength, std::size_t place) const noexcept
{
  constexpr double LAST = STRENGTHS - 1;
  const double deviation = parameters_.fatigue_spread > 0.0 ? log_strength / parameters_.fatigue_spread : 0.0;
  const double at = std::clamp(0.5 * LAST * (1.0 + deviation / STRENGTH_REACH), 0.0, LAST);
  const auto i = std::min(static_cast<std::size_t>(at), STRENGTHS - 2);
  const double share = at - static_cast<double>(i);
  return (1.0 - share) * usage.fatigue[i][place] + share * usage.fatigue[i + 1][place];
}

void RemainingLife::use(const Usage& usage) noexcept
{
  bearing_turns_ += usage.bearing_turns;
  fatigue_.addFatigue(usage, 1.0);
  for (Particle& particle : particles_)
  {
    particle.flank_wear += std::exp(particle.variation[FLANK]) * usage.flank_wear;
    particle.interface_wear += std::exp(particle.variation[INTERFACE]) * usage.interface_wear;
  }
}

void RemainingLife::read(const WearReading& reading) noexcept
{
  double largest = -HUGE_VAL;
  for (std::size_t i = 0; i < particles_.size(); ++i)
  {
    const double spall = std::min(spallSize(variationOf(particles_[i]), bearing_turns_), MAX_SPALL);
    const double deviation = squared((particles_[i].flank_wear - reading.flank_wear) / reading.flank_wear_error) +
                             squared((spall - reading.spall) / reading.spall_error);
    weights_[i] = std::log(weights_[i]) - 0.5 * deviation;
    largest = std::max(largest, weights_[i]);
  }
  double sum = 0.0;
  for (double& weight : weights_)
  {
    weight = std::exp(weight - largest);
    sum += weight;
  }
  double squares = 0.0;
  for (double& weight : weights_)
  {
    weight /= sum;
    squares += weight * weight;
  }
  if (squares * static_cast<double>(weights_.size()) > 2.0)
  {
    resample();
  }
}

bool RemainingLife::hasEnded(const Particle& particle) const noexcept
{
  bool broken = false;
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    broken = broken || fatigueBy(fatigue_, particle.variation[STRENGTH], place) >= 1.0;
  }
  return broken || particle.flank_wear >= parameters_.flank_wear_limit ||
         particle.interface_wear >= parameters_.interface_wear_limit ||
         spallSize(variationOf(particle), bearing_turns_) >= 1.0;
}

void RemainingLife::survive() noexcept
{
  double left = 0.0;
  for (std::size_t i = 0; i < particles_.size(); ++i)
  {
    left += hasEnded(particles_[i]) ? 0.0 : weights_[i];
  }
  for (std::size_t i = 0; i < particles_.size() && left > 0.0; ++i)
  {
    weights_[i] = hasEnded(particles_[i]) ? 0.0 : weights_[i] / left;
  }
}

void RemainingLife::resample() noexcept
{
  // Systematic: one draw for all.
  const double spacing = 1.0 / static_cast<double>(particles_.size());
  double mark = spacing * boost::random::uniform_01<double>()(random_);
  std::array<double, NATURES> mean{};
  for (std::size_t i = 0; i < particles_.size(); ++i)
  {
    for (int k = 0; k < NATURES; ++k)
    {
      mean[k] += weights_[i] * particles_[i].variation[k];
    }
  }
  std::array<double, NATURES> variance{};
  for (std::size_t i = 0; i < particles_.size(); ++i)
  {
    for (int k = 0; k < NATURES; ++k)
    {
      variance[k] += weights_[i] * squared(particles_[i].variation[k] - mean[k]);
    }
  }
  std::size_t from = 0;
  double reached = weights_[0];
  boost::random::normal_distribution<double> normal;
  constexpr double SHRINK = 0.98;  // (3 d - 1) / (2 d) with Liu and West's discount d = 0.96
  const double spread = std::sqrt(1.0 - SHRINK * SHRINK);
  for (Particle& drawn : drawn_)
  {
    while (reached < mark && from + 1 < particles_.size())
    {
      reached += weights_[++from];
    }
    mark += spacing;
    drawn = particles_[from];
    const double flank_before = drawn.variation[FLANK];
    const double interface_before = drawn.variation[INTERFACE];
    for (int k = 0; k < NATURES; ++k)
    {
      drawn.variation[k] =
          mean[k] + SHRINK * (drawn.variation[k] - mean[k]) + spread * std::sqrt(variance[k]) * normal(random_);
    }
    // Another variation would have worn another depth by the same use.
    drawn.flank_wear *= std::exp(drawn.variation[FLANK] - flank_before);
    drawn.interface_wear *= std::exp(drawn.variation[INTERFACE] - interface_before);
  }
  particles_.swap(drawn_);
  std::fill(weights_.begin(), weights_.end(), spacing);
}

RemainingHours RemainingLife::remaining(const FutureLoad& future_load) noexcept
{
  RemainingHours result;
  for (std::size_t i = 0; i < particles_.size(); ++i)
  {
    const Particle& particle = particles_[i];
    const UnitVariation variation = variationOf(particle);
    const auto until_broken = [&](std::size_t place)
    {
      const double strength = particle.variation[STRENGTH];
      return hoursUntil(future_load, 1.0 - fatigueBy(fatigue_, strength, place),
                        [&](const Usage& usage) { return fatigueBy(usage, strength, place); });
    };
    const std::array<double, 3 + STRESS_PLACES> hours{
      hoursUntil(future_load, (parameters_.flank_wear_limit - particle.flank_wear) / variation.flank_factor,
                 [](const Usage& usage) { return usage.flank_wear; }),
      hoursUntil(future_load, (parameters_.interface_wear_limit - particle.interface_wear) / variation.interface_factor,
                 [](const Usage& usage) { return usage.interface_wear; }),
      hoursUntil(future_load, variation.bearing_life * (1.0 + variation.spall_growth) - bearing_turns_,
                 [](const Usage& usage) { return usage.bearing_turns; }),
      until_broken(0),
      until_broken(1),
      until_broken(2)
    };
    const auto first = std::min_element(hours.begin(), hours.end());
    result.by_cause[static_cast<std::size_t>(first - hours.begin())] += weights_[i];
    result.ended += *first == 0.0 ? weights_[i] : 0.0;
    ends_[i] = { *first, weights_[i] };
  }
  std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) { return a.hours < b.hours; });
  double reached = 0.0;
  std::size_t quantile = 0;
  for (const End& end : ends_)
  {
    reached += end.weight;
    for (; quantile < result.quantile.size() && reached >= RemainingHours::SHARES[quantile]; ++quantile)
    {
      result.quantile[quantile] = end.hours;
    }
  }
  for (; quantile < result.quantile.size(); ++quantile)  // the weights' sum falls short of 1 by rounding
  {
    result.quantile[quantile] = ends_.back().hours;
  }
  return result;
}
}  // namespace hjt
