// SPDX-License-Identifier: BSD-3-Clause
#include "life/drive_ageing.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>

#include <boost/numeric/odeint.hpp>

namespace hjt
{
namespace
{
// Entries of a drive's age for the integrator, each divided by its limit.
enum Entry
{
  TURNS,
  FLANK,  // for loads > 0, followed by loads < 0
  INTERFACE = FLANK + 2,
  GREASE,
  FLAW,
  BEARING,
  FATIGUE,  // for the first place, followed by the other places
  ENTRIES = FATIGUE + STRESS_PLACES
};
using Entries = std::array<double, ENTRIES>;

struct Scale
{
  explicit Scale(const AgeingParameters& parameters, const UnitVariation& variation)
    : by{ parameters.life.grease_turns,
          parameters.life.flank_wear_limit,
          parameters.life.flank_wear_limit,
          parameters.life.interface_wear_limit,
          1.0,
          parameters.gear.rim_thickness,
          variation.bearing_life }
  {
    std::fill(by.begin() + FATIGUE, by.end(), 1.0);
  }

  Entries from(const DriveAge& age) const
  {
    Entries entries{ age.turns,  age.flank_wear[0], age.flank_wear[1], age.interface_wear,
                     age.grease, age.flaw_depth,    age.bearing_turns };
    std::copy(age.fatigue.begin(), age.fatigue.end(), entries.begin() + FATIGUE);
    std::transform(entries.begin(), entries.end(), by.begin(), entries.begin(), std::divides<>());
    return entries;
  }

  DriveAge to(Entries entries) const
  {
    std::transform(entries.begin(), entries.end(), by.begin(), entries.begin(), std::multiplies<>());
    DriveAge age{ entries[TURNS],
                  { entries[FLANK], entries[FLANK + 1] },
                  entries[INTERFACE],
                  entries[GREASE],
                  entries[FLAW],
                  entries[BEARING],
                  {},
                  filling_factor };
    std::copy(entries.begin() + FATIGUE, entries.end(), age.fatigue.begin());
    return age;
  }

  Entries by;
  double filling_factor{ 1.0 };  // DriveAge::filling_factor
};
}  // namespace

UnitVariation nominalDrive(const LifeParameters& parameters)
{
  return { 1.0, 1.0, BearingLife(parameters).quantile(0.5), parameters.spall_growth, 1.0, 1.0, 0 };
}

void DriveAgeing::addFatigue(double turns, const RevolutionLoad& revolution_load, const UnitVariation& variation,
                             std::array<MinerSum, STRESS_PLACES>& fatigue) const
{
  constexpr double CYCLES_A_TURN = 2.0;
  for (std::size_t place = 0; place < STRESS_PLACES && turns > 0.0; ++place)
  {
    fatigue[place].add(
        fatigue_law_, CYCLES_A_TURN * turns,
        fatigue_law_.enduranceShare(place, revolution_load.stress[place]) / strengthOf(variation, place));
  }
}

std::array<double, STRESS_PLACES> DriveAgeing::fatigueRates(double strength) const
{
  UnitVariation variation;
  variation.strength = strength;
  double time = 0.0;
  std::array<MinerSum, STRESS_PLACES> fatigue;
  for (const DutyPhase& phase : duty_.phases)
  {
    time += phase.duration;
    addFatigue(phase.turns(), load_map_.at(phase.load_torque, 0.0, 0.0), variation, fatigue);
  }
  std::array<double, STRESS_PLACES> rates{};
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    rates[place] = fatigue[place].sum() * 3600.0 / time;
  }
  return rates;
}

DriveAge DriveAgeing::rates(const UnitVariation& variation, const DriveAge& age) const
{
  const LifeParameters& life = parameters_.life;
  const GearParameters& gear = parameters_.gear;
  const double flank_area = life.face_width * gear.tooth_height_flexspline;
  const double interface_area = life.face_width * TWO_PI * gear.flexspline_inner_radius;
  const double grease_factor = age.filling_factor * greaseWearFactor(life, age.grease);
  double time = 0.0;
  DriveAge rate;
  std::array<MinerSum, STRESS_PLACES> fatigue;
  for (const DutyPhase& phase : duty_.phases)
  {
    const RevolutionLoad revolution_load = load_map_.at(phase.load_torque, age.meanFlank(), age.interface_wear);
    const double turns = phase.turns();
    time += phase.duration;
    rate.turns += turns;
    // The factor 2 is for both surfaces of a pair, which have equal force and sliding and each lose a depth. The sign
    // of the load selects the flank.
    rate.flank_wear[phase.load_torque < 0.0 ? 1 : 0] +=
        turns * 2.0 * variation.flank_factor * grease_factor *
        archardDepth(life.flank_wear_coefficient, revolution_load.flank_sliding, flank_area);
    rate.interface_wear +=
        turns * 2.0 * variation.interface_factor * grease_factor *
        archardDepth(life.interface_wear_coefficient, revolution_load.interface_sliding, interface_area);
    rate.grease += turns * greaseAgeing(life, phase.temperature);
    rate.flaw_depth += turns * crackGrowth(parameters_, revolution_load, age.flaw_depth);
    rate.bearing_turns += turns * bearingWear(life, phase.load_torque);
    addFatigue(turns, revolution_load, variation, fatigue);
  }
  rate.grease *= rate.turns > 0.0 ? greaseLoadFactor(rate.bearing_turns / rate.turns) : 1.0;
  const double per_hour = 3600.0 / time;
  rate.turns *= per_hour;
  for (double& wear : rate.flank_wear)
  {
    wear *= per_hour;
  }
  rate.interface_wear *= per_hour;
  rate.grease *= per_hour;
  rate.flaw_depth *= per_hour;
  rate.bearing_turns *= per_hour;
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    rate.fatigue[place] = fatigue[place].sum() * per_hour;
  }
  return rate;
}

std::optional<EndOfLife> DriveAgeing::ended(const UnitVariation& variation, const DriveAge& age) const
{
  if (age.worstFlank() >= parameters_.life.flank_wear_limit)
  {
    return EndOfLife::FLANK_WEAR;
  }
  if (age.interface_wear >= parameters_.life.interface_wear_limit)
  {
    return EndOfLife::INTERFACE_WEAR;
  }
  if (age.flaw_depth >= parameters_.gear.rim_thickness)
  {
    return EndOfLife::ROOT_CRACK;
  }
  if (spallSize(variation, age.bearing_turns) >= 1.0)
  {
    return EndOfLife::BEARING;
  }
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    if (age.fatigue[place] >= 1.0)
    {
      return fatigueAt(place);
    }
  }
  return std::nullopt;
}

DriveAgeing::Life DriveAgeing::live(const UnitVariation& variation, double hours, double every, bool grease_changes,
                                    const std::function<void(double, const DriveAge&)>& visit) const
{
  constexpr double TOLERANCE = 1e-8;  // largest error of a step, as a share of the limits [-]
  constexpr int BISECTIONS = 50;
  namespace odeint = boost::numeric::odeint;
  Scale scale(parameters_, variation);
  std::uint32_t filling = 0;
  scale.filling_factor = fillingFactor(variation, filling);
  const auto rhs = [&](const Entries& at, Entries& rate, double) { rate = scale.from(rates(variation, scale.to(at))); };

  DriveAge age;
  age.flaw_depth = parameters_.life.flaw_depth;
  auto stepper = odeint::make_dense_output(TOLERANCE, TOLERANCE, odeint::runge_kutta_dopri5<Entries>());
  stepper.initialize(scale.from(age), 0.0, std::min(1.0, hours));
  Entries entries{};
  const auto age_at = [&](double time)
  {
    stepper.calc_state(time, entries);
    return scale.to(entries);
  };
  const auto stops = [&](double time)
  {
    const DriveAge then = age_at(time);
    return time >= hours || ended(variation, then) || (grease_changes && then.grease >= 1.0);
  };

  double next_visit = 0.0;
  while (true)
  {
    auto [begin, end] = stepper.do_step(rhs);
    const bool stopping = stops(end);
    if (stopping)
    {
      // Bisects to the instant of an event: end of use or of the hours, or change of grease. A step has at most one.
      for (int i = 0; i < BISECTIONS; ++i)
      {
        const double middle = 0.5 * (begin + end);
        (stops(middle) ? end : begin) = middle;
      }
    }
    for (; visit && next_visit < end; next_visit += every)
    {
      visit(next_visit, age_at(next_visit));
    }
    if (!stopping)
    {
      continue;
    }
    age = age_at(end);
    const std::optional<EndOfLife> why = ended(variation, age);
    if (why || end >= hours * (1.0 - 1e-12))
    {
      if (visit)
      {
        visit(end, age);
      }
      return { end, why, age };
    }
    age.grease = 0.0;
    scale.filling_factor = fillingFactor(variation, ++filling);
    stepper.initialize(scale.from(age), end, std::max(1e-6, end - begin) + 1e-3 * end);
  }
}
}  // namespace hjt
