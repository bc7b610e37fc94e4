// SPDX-License-Identifier: BSD-3-Clause
#include "life/remaining_life.hpp"

#include <boost/random/sobol.hpp>

#include "gear/angle.hpp"
#include "life/read_wear.hpp"

namespace hjt
{
namespace
{
using namespace assessment_errors;

constexpr double SEVERITY_RANGE = 0.9;  // range of the signatures' severities: 0.1 to 1
constexpr double LEAST_FATIGUE_SPREAD = 1e-6;
constexpr double LEAST_SPREAD = 0.1;  // least standard deviation of a severity's logarithm between assessments

/// Hours until the future use has increased a quantity by `left`. `of`: function that returns the quantity of a Usage.
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

/// Miner's sum at a place after the use `usage` [-]. `strength`: ln(strength at the place / median strength).
double fatigueBy(const Usage& usage, double strength, std::size_t place) noexcept
{
  constexpr double LAST = STRENGTHS - 1;
  const double at = std::clamp(0.5 * LAST * (1.0 + strength / STRENGTH_REACH), 0.0, LAST);
  const auto i = std::min(static_cast<std::size_t>(at), STRENGTHS - 2);
  const double share = at - static_cast<double>(i);
  const double weaker = usage.fatigue[i][place];
  const double stronger = usage.fatigue[i + 1][place];
  return weaker > 0.0 && stronger > 0.0 ? weaker * std::pow(stronger / weaker, share) :
                                          (1.0 - share) * weaker + share * stronger;
}

/// Variance of ln(future mean rate of wear / past mean rate), if the logarithms of the rates of single fillings of
/// grease have unit variance. The current filling is past and future. `so_far`, `ahead`: number of fillings of each.
double changeOfRate(double so_far, double ahead) noexcept
{
  if (ahead <= 0.0)
  {
    return 0.0;
  }
  const auto squares = [](double fillings)  // sum of the squares of the fillings' lengths
  { return std::floor(fillings) + squared(fillings - std::floor(fillings)); };
  const double begun = so_far - std::floor(so_far);
  const double left = std::min(1.0 - begun, ahead);
  const double of_one = so_far > 0.0 ? 1.0 / so_far : 0.0;  // share of one filling in the use so far
  return std::floor(so_far) * squared(of_one) + squared(left / ahead - begun * of_one) +
         squares(ahead - left) / squared(ahead);
}

/// Wear of a particle as a severity, and the probability that an assessment finds this wear.
struct Wear
{
  Wear(FaultKind kind, double size) noexcept
    : severity(size)
    , found(size > 0.0 ? detectionShare(kind) * normalShare(std::log(size / DETECTED_SEVERITY) / DETECTED_SPREAD) : 0.0)
  {
  }

  double severity;
  double found;
};

/// Probability density of an estimated severity, log-normal about the true `severity`, over a uniform density on
/// SEVERITY_RANGE [-].
double estimateDensity(const Alternative& estimate, double severity) noexcept
{
  if (severity <= 0.0 || estimate.severity <= 0.0)
  {
    return 0.0;
  }
  const double stated = std::sqrt(std::log1p(squared(estimate.severity_deviation / estimate.severity)));
  const double spread = std::max(stated, LEAST_SPREAD);
  return SEVERITY_RANGE * std::exp(-0.5 * squared(std::log(estimate.severity / severity) / spread)) /
         (estimate.severity * spread * std::sqrt(TWO_PI));
}
}  // namespace

double RemainingHours::crps(double hours) const noexcept
{
  // Integral of (F - H)^2, with F the distribution and H the step at `hours`. Where F - H is linear from a to b, the
  // integral is length (a^2 + a b + b^2) / 3.
  double sum = 0.0;
  double reached = 0.0;
  const auto add = [&](double from, double to, double at_from, double at_to, double step)
  {
    const double a = at_from - step;
    const double b = at_to - step;
    sum += (to - from) * (a * a + a * b + b * b) / 3.0;
  };
  for (std::size_t i = 0; i + 1 < BINS; ++i)
  {
    const double from = edge(i);
    const double to = edge(i + 1);
    const double next = reached + probability[i];
    if (hours <= from || hours >= to)
    {
      add(from, to, reached, next, hours <= from ? 1.0 : 0.0);
    }
    else
    {
      const double middle = reached + probability[i] * (hours - from) / (to - from);
      add(from, hours, reached, middle, 0.0);
      add(hours, to, middle, next, 1.0);
    }
    reached = next;
  }
  return sum + std::max(hours - edge(BINS - 1), 0.0);
}

RemainingLife::RemainingLife(const Parameters& parameters)
  : parameters_(parameters.life)
  , fault_scale_(parameters.fault_scale)
  , bearing_(parameters.life)
  , points_(PARTICLES)
  , drives_(PARTICLES)
  , ends_(PARTICLES)
{
  boost::random::sobol engine(NATURES);
  const double range = static_cast<double>(boost::random::sobol::max()) + 1.0;
  for (Point& point : points_)
  {
    for (double& coordinate : point)
    {
      coordinate = (static_cast<double>(engine()) + 0.5) / range;
    }
  }
}

/// Strength at each place below which the use so far would have broken the drive, as ln(strength / median strength).
RemainingLife::Weakest RemainingLife::weakestLeft(const Usage& so_far) const noexcept
{
  Weakest weakest{};
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    double broken = -STRENGTH_REACH;
    double whole = STRENGTH_REACH;
    const bool none = fatigueBy(so_far, broken, place) < 1.0;
    for (int i = 0; i < 40 && !none && fatigueBy(so_far, whole, place) < 1.0; ++i)
    {
      const double middle = 0.5 * (broken + whole);
      (fatigueBy(so_far, middle, place) < 1.0 ? whole : broken) = middle;
    }
    weakest[place] = none ? -FARTHEST * FARTHEST : whole;
  }
  return weakest;
}

RemainingLife::Drive RemainingLife::drive(const Point& point, const Usage& so_far, const Weakest& weakest,
                                          bool is_spalled, const WearTrends& trends) const noexcept
{
  Drive drive;
  drive.variation.flank_factor = flank_factors_.drawn(point[FLANK]);
  drive.variation.interface_factor = interface_factors_.drawn(point[INTERFACE]);
  drive.rate_ahead = normalAt(point[RATE_AHEAD]);
  drive.flank_end = flank_limit_ / drive.variation.flank_factor;
  if (trends.flank.isKnown() && std::isfinite(trends.reading_at_end))
  {
    const double by_lost_motion =
        trends.flank_depth * trends.flank.nominalAt(trends.reading_at_end, drive.variation.flank_factor,
                                                    normalAt(point[READING_GAIN]), normalAt(point[READING_OFFSET]));
    drive.flank_end = std::min(drive.flank_end, std::max(by_lost_motion, so_far.flank_wear));
  }
  drive.variation.spall_growth =
      parameters_.spall_growth * factorBelow(HUGE_VAL, parameters_.spall_spread, point[SPALL_GROWTH]);
  // -ln of the share of bearings without a spall after a number of turns (Weibull). `whole`: after all turns so far;
  // `least`: after the turns at which a spall began whose growth ends the use now.
  const auto lasting = [this](double turns) { return std::pow(turns / bearing_.scale, bearing_.shape); };
  const double least = lasting(so_far.bearing_turns / (1.0 + drive.variation.spall_growth));
  const double whole = lasting(so_far.bearing_turns);
  const double share_spalled = -std::expm1(least - whole);
  const double drawn =
      is_spalled ? least - std::log1p(-point[BEARING_LIFE] * share_spalled) : whole - std::log1p(-point[BEARING_LIFE]);
  drive.variation.bearing_life = bearing_.scale * std::pow(drawn, 1.0 / bearing_.shape);
  drive.log_weight = is_spalled ? std::log(share_spalled / SPALLED) - least : -whole - std::log(1.0 - SPALLED);
  constexpr auto AT_TRANSITION = static_cast<std::size_t>(StressPlace::TRANSITION);
  drive.strength = {};
  drive.strength[AT_TRANSITION] = TRANSITION_SCATTER * normalAt(point[TRANSITION]);
  const double spread = std::max(parameters_.fatigue_spread, LEAST_FATIGUE_SPREAD);
  double weakest_left = -FARTHEST;  // least strength of an unbroken drive, as a normal deviate
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    weakest_left = std::max(weakest_left, (weakest[place] - drive.strength[place]) / spread);
  }
  weakest_left = std::min(weakest_left, FARTHEST);
  const double deviation = -normalBelow(-weakest_left, point[STRENGTH]);
  for (double& strength : drive.strength)
  {
    strength += spread * deviation;
  }
  drive.log_weight += std::log(std::max(normalShare(-weakest_left), 1e-300));
  return drive;
}

double RemainingLife::likelihood(const Assessment& assessment, const Usage& so_far, const Usage& at_reference,
                                 const UnitVariation& variation, bool wear_is_read) const noexcept
{
  if (wear_is_read && assessment.level == HealthLevel::OK)
  {
    return 1.0;
  }
  const Wear flank(FaultKind::TOOTH_WEAR, variation.flank_factor * (so_far.mean_flank - at_reference.mean_flank) /
                                              fault_scale_.tooth_wear_depth);
  const Wear interface(FaultKind::INTERFACE_WEAR, variation.interface_factor *
                                                      (so_far.interface_wear - at_reference.interface_wear) /
                                                      fault_scale_.interface_wear_depth);
  if (assessment.level == HealthLevel::OK)
  {
    return !assessment.shows_play ? 1.0 : (1.0 - flank.found) * (1.0 - interface.found);
  }
  const double spall = std::min(spallSize(variation, so_far.bearing_turns), 1.0) -
                       std::min(spallSize(variation, at_reference.bearing_turns), 1.0);
  double known = 0.0;
  double sum = 0.0;
  const auto add = [&](const Alternative& item)
  {
    if (wear_is_read &&
        (item.cause == causeOf(FaultKind::TOOTH_WEAR) || item.cause == causeOf(FaultKind::INTERFACE_WEAR)))
    {
      known += item.confidence;
      sum += item.confidence;  // equal for all particles, because the readings already contain this evidence
      return;
    }
    if (item.cause == causeOf(FaultKind::TOOTH_WEAR))
    {
      known += item.confidence;
      sum += item.confidence * flank.found * estimateDensity(item, flank.severity);
    }
    else if (item.cause == causeOf(FaultKind::INTERFACE_WEAR))
    {
      known += item.confidence;
      sum += item.confidence * interface.found * estimateDensity(item, interface.severity);
    }
    else if (item.cause == causeOf(FaultKind::BEARING_INNER_RACE) ||
             item.cause == causeOf(FaultKind::BEARING_OUTER_RACE) || item.cause == causeOf(FaultKind::BEARING_BALL))
    {
      known += item.confidence;
      sum += item.confidence * estimateDensity(item, spall);
    }
  };
  add({ assessment.cause, assessment.confidence, assessment.severity, assessment.severity_deviation });
  for (std::size_t i = 0; i < assessment.alternative_count; ++i)
  {
    add(assessment.alternatives[i]);
  }
  return sum + (1.0 - IN_SET) * std::max(1.0 - known, FALSE_ALARMS);
}

std::array<double, RemainingHours::CAUSES.size()> RemainingLife::hoursLeft(const Drive& drive, const Usage& so_far,
                                                                           const FutureLoad& future_load) const noexcept
{
  const UnitVariation& variation = drive.variation;
  const auto until_broken = [&](std::size_t place)
  {
    const double strength = drive.strength[place];
    return hoursUntil(future_load, 1.0 - fatigueBy(so_far, strength, place),
                      [&](const Usage& usage) { return fatigueBy(usage, strength, place); });
  };
  // The rates of flank and interface wear change by the same factor, because the grease is the same.
  const auto until_worn = [&](double end, double now, auto&& of)
  {
    const double ahead = so_far.fillings * (end / std::max(now, 1e-300) - 1.0);
    const double factor = std::exp(RATE_SCATTER * std::sqrt(changeOfRate(so_far.fillings, ahead)) * drive.rate_ahead);
    return hoursUntil(future_load, (end - now) / factor, of);
  };
  return { until_worn(drive.flank_end, so_far.flank_wear, [](const Usage& usage) { return usage.flank_wear; }),
           until_worn(interface_limit_ / variation.interface_factor, so_far.interface_wear,
                      [](const Usage& usage) { return usage.interface_wear; }),
           hoursUntil(future_load, variation.bearing_life * (1.0 + variation.spall_growth) - so_far.bearing_turns,
                      [](const Usage& usage) { return usage.bearing_turns; }),
           until_broken(0),
           until_broken(1),
           until_broken(2) };
}

RemainingHours RemainingLife::remaining(const Usage& so_far, const FutureLoad& future_load,
                                        const Assessment* assessment, const Usage& at_reference,
                                        const WearTrends& trends) noexcept
{
  flank_limit_ = future_load.flank_limit > 0.0 ? future_load.flank_limit : parameters_.flank_wear_limit;
  interface_limit_ = future_load.interface_limit > 0.0 ? future_load.interface_limit : parameters_.interface_wear_limit;
  flank_factors_.given(trends.flank, parameters_.wear_spread, flank_limit_ / so_far.flank_wear);
  interface_factors_.given(trends.interface, parameters_.wear_spread, interface_limit_ / so_far.interface_wear);
  const bool wear_is_read = trends.flank.isKnown() && trends.interface.isKnown();
  const Weakest weakest = weakestLeft(so_far);
  double largest = -HUGE_VAL;  // logarithms prevent an underflow of the weights
  for (std::size_t i = 0; i < PARTICLES; ++i)
  {
    const bool is_spalled = static_cast<double>(i) < SPALLED * static_cast<double>(PARTICLES);
    drives_[i] = drive(points_[i], so_far, weakest, is_spalled, trends);
    largest = std::max(largest, drives_[i].log_weight);
  }
  RemainingHours result;
  double sum = 0.0;
  for (std::size_t i = 0; i < PARTICLES; ++i)
  {
    const Drive& particle = drives_[i];
    const auto hours = hoursLeft(particle, so_far, future_load);
    const auto first = std::min_element(hours.begin(), hours.end());
    const double weight =
        std::exp(particle.log_weight - largest) *
        (assessment != nullptr ? likelihood(*assessment, so_far, at_reference, particle.variation, wear_is_read) : 1.0);
    result.by_cause[static_cast<std::size_t>(first - hours.begin())] += weight;
    ends_[i] = { *first, weight };
    sum += weight;
  }
  for (double& share : result.by_cause)
  {
    share /= sum;
  }
  summarize(result, sum);
  return result;
}

/// Fills bins and quantiles of `result` from the particles' ends. `sum`: sum of the weights of the ends.
void RemainingLife::summarize(RemainingHours& result, double sum) noexcept
{
  std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) { return a.hours < b.hours; });
  double reached = 0.0;
  std::size_t quantile = 0;
  std::size_t bin = 0;
  for (const End& end : ends_)
  {
    while (bin + 1 < RemainingHours::BINS && end.hours >= RemainingHours::edge(bin + 1))
    {
      ++bin;
    }
    result.probability[bin] += end.weight / sum;
    reached += end.weight / sum;
    for (; quantile < result.quantile.size() && reached >= RemainingHours::SHARES[quantile]; ++quantile)
    {
      result.quantile[quantile] = end.hours;
    }
  }
  for (; quantile < result.quantile.size(); ++quantile)  // rounding may leave the sum of the weights below 1
  {
    result.quantile[quantile] = ends_.back().hours;
  }
}
}  // namespace hjt
