// SPDX-License-Identifier: BSD-3-Clause
#include "studies/life_trials.hpp"

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>

namespace hjt
{
namespace
{
/// Follows one life with a filter that knows the use, and the readings with their errors.
class Watch
{
public:
  Watch(const Parameters& parameters, const DriveAgeing& ageing, const LifeTrialOptions& options, std::uint32_t seed)
    : options_(options)
    , use_(ageing, parameters.life, options.grease_changes)
    , filter_(parameters.life, options.particles, seed)
    , random_(seed)
  {
  }

  RemainingHours reading(double hours, const UnitVariation& variation, const DriveAge& age)
  {
    constexpr int STRETCHES = 400;
    constexpr double HORIZON = 3.0;  // of the present age; past it use goes on as in the last stretch
    const Usage usage = use_.until(hours);
    filter_.use(usage - used_);
    used_ = usage;
    filter_.read({ age.worstFlank() + options_.flank_wear_error * normal_(random_), options_.flank_wear_error,
                   spallSize(variation, age.bearing_turns) + options_.spall_error * normal_(random_),
                   options_.spall_error });
    filter_.survive();  // fatigue is not seen before it breaks the flexspline
    return filter_.remaining(use_.from(hours, HORIZON * (hours + options_.every), STRETCHES));
  }

private:
  LifeTrialOptions options_;
  NominalUse use_;
  RemainingLife filter_;
  boost::random::mt19937 random_;
  boost::random::normal_distribution<double> normal_;
  Usage used_;
};
}  // namespace

Coverage coverage(const std::vector<LifeTrial>& trials, double from)
{
  Coverage coverage;
  for (const LifeTrial& trial : trials)
  {
    for (const LifeForecast& forecast : trial.forecasts)
    {
      if (forecast.hours >= from * trial.life.hours)
      {
        ++coverage.forecasts;
        coverage.held += forecast.held() ? 1 : 0;
      }
    }
  }
  return coverage;
}

std::vector<LifeTrial> runLifeTrials(const Parameters& parameters, const DriveAgeing& ageing,
                                     const LifeTrialOptions& options, double longest,
                                     const std::function<void(double)>& progress)
{
  const BearingLife bearing(parameters.life);
  boost::random::mt19937 random(options.seed);
  std::vector<LifeTrial> trials;
  for (int i = 0; i < options.lives; ++i)
  {
    const UnitVariation variation = drawVariation(parameters.life, bearing, random);
    LifeTrial trial{ variation, ageing.live(variation, longest, longest, options.grease_changes, {}), {} };
    if (trial.life.end)
    {
      Watch watch(parameters, ageing, options, options.seed + static_cast<std::uint32_t>(i) + 1u);
      ageing.live(
          variation, trial.life.hours, options.every, options.grease_changes,
          [&](double hours, const DriveAge& age)
          {
            if (hours > 0.0 && hours < trial.life.hours)
            {
              trial.forecasts.push_back({ hours, trial.life.hours - hours, watch.reading(hours, variation, age) });
            }
          });
    }
    trials.push_back(std::move(trial));
    progress((i + 1.0) / options.lives);
  }
  return trials;
}
}  // namespace hjt
