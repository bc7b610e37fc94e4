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
  NATURES
};

/// Hours until the use ahead has grown by `left`, of what `of` takes from a usage.
template <class Of>
double hoursUntil(const Outlook& outlook, double left, Of&& of)
{
  if (left <= 0.0)
  {
    return 0.0;
  }
  const auto after = std::lower_bound(outlook.usage.begin() + 1, outlook.usage.end() - 1, left,
                                      [&](const Usage& usage, double value) { return of(usage) < value; });
  const auto before = after - 1;
  const double stretch = of(*after) - of(*before);
  const auto begin = static_cast<double>(before - outlook.usage.begin());
  return stretch > 0.0 ? outlook.step * (begin + (left - of(*before)) / stretch) : HUGE_VAL;
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
    const DriveNature nature = drawNature(parameters, bearing, random_);
    particle.nature = { std::log(nature.flank_factor), std::log(nature.interface_factor), std::log(nature.bearing_life),
                        std::log(nature.spall_growth) };
    particle.flank_wear = 0.0;
    particle.interface_wear = 0.0;
  }
}

DriveNature RemainingLife::natureOf(const Particle& particle) noexcept
{
  return { std::exp(particle.nature[FLANK]), std::exp(particle.nature[INTERFACE]),
           std::exp(particle.nature[BEARING_LIFE]), std::exp(particle.nature[SPALL_GROWTH]) };
}

void RemainingLife::use(const Usage& usage) noexcept
{
  bearing_turns_ += usage.bearing_turns;
  for (Particle& particle : particles_)
  {
    particle.flank_wear += std::exp(particle.nature[FLANK]) * usage.flank_wear;
    particle.interface_wear += std::exp(particle.nature[INTERFACE]) * usage.interface_wear;
  }
}

void RemainingLife::read(const WearReading& reading) noexcept
{
  double largest = -HUGE_VAL;
  for (std::size_t i = 0; i < particles_.size(); ++i)
  {
    const double spall = std::min(spallSize(natureOf(particles_[i]), bearing_turns_), LARGEST_SPALL);
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
  return particle.flank_wear >= parameters_.flank_wear_limit ||
         particle.interface_wear >= parameters_.interface_wear_limit ||
         spallSize(natureOf(particle), bearing_turns_) >= 1.0;
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
      mean[k] += weights_[i] * particles_[i].nature[k];
    }
  }
  std::array<double, NATURES> variance{};
  for (std::size_t i = 0; i < particles_.size(); ++i)
  {
    for (int k = 0; k < NATURES; ++k)
    {
      variance[k] += weights_[i] * squared(particles_[i].nature[k] - mean[k]);
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
    const double flank_before = drawn.nature[FLANK];
    const double interface_before = drawn.nature[INTERFACE];
    for (int k = 0; k < NATURES; ++k)
    {
      drawn.nature[k] =
          mean[k] + SHRINK * (drawn.nature[k] - mean[k]) + spread * std::sqrt(variance[k]) * normal(random_);
    }
    // Another nature would have worn another depth by the same use.
    drawn.flank_wear *= std::exp(drawn.nature[FLANK] - flank_before);
    drawn.interface_wear *= std::exp(drawn.nature[INTERFACE] - interface_before);
  }
  particles_.swap(drawn_);
  std::fill(weights_.begin(), weights_.end(), spacing);
}

RemainingHours RemainingLife::remaining(const Outlook& outlook) noexcept
{
  RemainingHours result;
  for (std::size_t i = 0; i < particles_.size(); ++i)
  {
    const Particle& particle = particles_[i];
    const DriveNature nature = natureOf(particle);
    const std::array<double, 3> hours{
      hoursUntil(outlook, (parameters_.flank_wear_limit - particle.flank_wear) / nature.flank_factor,
                 [](const Usage& usage) { return usage.flank_wear; }),
      hoursUntil(outlook, (parameters_.interface_wear_limit - particle.interface_wear) / nature.interface_factor,
                 [](const Usage& usage) { return usage.interface_wear; }),
      hoursUntil(outlook, nature.bearing_life * (1.0 + nature.spall_growth) - bearing_turns_,
                 [](const Usage& usage) { return usage.bearing_turns; })
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
