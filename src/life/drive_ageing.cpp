// SPDX-License-Identifier: BSD-3-Clause
#include "life/drive_ageing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/numeric/odeint.hpp>

namespace hjt
{
namespace
{
// A drive's age as the integrator sees it, each entry in units of its own limit.
enum Entry
{
  TURNS,
  FLANK,
  INTERFACE,
  GREASE,
  FLAW,
  BEARING,
  ENTRIES
};
using Entries = std::array<double, ENTRIES>;

struct Scale
{
  explicit Scale(const LifeParameters& life, const GearParameters& gear, const UnitVariation& variation)
    : by{ life.grease_turns,  life.flank_wear_limit, life.interface_wear_limit, 1.0,
          gear.rim_thickness, variation.bearing_life }
  {
  }

  Entries from(const DriveAge& age) const
  {
    return { age.turns / by[TURNS],   age.flank_wear / by[FLANK], age.interface_wear / by[INTERFACE],
             age.grease / by[GREASE], age.flaw_depth / by[FLAW],  age.bearing_turns / by[BEARING] };
  }

  DriveAge to(const Entries& entries) const
  {
    return { entries[TURNS] * by[TURNS],   entries[FLANK] * by[FLANK], entries[INTERFACE] * by[INTERFACE],
             entries[GREASE] * by[GREASE], entries[FLAW] * by[FLAW],   entries[BEARING] * by[BEARING] };
  }

  Entries by;
};
}  // namespace

UnitVariation nominalDrive(const LifeParameters& parameters)
{
  return { 1.0, 1.0, BearingLife(parameters).quantile(0.5), parameters.spall_growth };
}

DriveAge DriveAgeing::rates(const UnitVariation& variation, const DriveAge& age) const
{
  const double height = gear_.tooth_height_flexspline;
  const double flank_area = life_.face_width * height;
  const double interface_area = life_.face_width * TWO_PI * gear_.flexspline_inner_radius;
  const double grease_factor = greaseWearFactor(life_, age.grease);
  double time = 0.0;
  DriveAge rate;
  for (const DutyPhase& phase : duty_.phases)
  {
    const RevolutionLoad revolution_load = load_map_.at(phase.load_torque, age.flank_wear, age.interface_wear);
    const double turns = phase.turns();
    time += phase.duration;
    rate.turns += turns;
    // Each of the two surfaces loses its own depth: those of a pair share force and way.
    rate.flank_wear += turns * 2.0 * variation.flank_factor * grease_factor *
                       archardDepth(life_.flank_wear_coefficient, revolution_load.flank_sliding, flank_area);
    rate.interface_wear +=
        turns * 2.0 * variation.interface_factor * grease_factor *
        archardDepth(life_.interface_wear_coefficient, revolution_load.interface_sliding, interface_area);
    rate.grease += turns * greaseAgeing(life_, phase.temperature);
    rate.flaw_depth += turns * crackGrowth(life_, revolution_load.rim_stress_range, age.flaw_depth);
    rate.bearing_turns += turns * bearingWear(life_, phase.load_torque);
  }
  const double per_hour = 3600.0 / time;
  rate.turns *= per_hour;
  rate.flank_wear *= per_hour;
  rate.interface_wear *= per_hour;
  rate.grease *= per_hour;
  rate.flaw_depth *= per_hour;
  rate.bearing_turns *= per_hour;
  return rate;
}

std::optional<EndOfLife> DriveAgeing::ended(const UnitVariation& variation, const DriveAge& age) const
{
  if (age.flank_wear >= life_.flank_wear_limit)
  {
    return EndOfLife::FLANK_WEAR;
  }
  if (age.interface_wear >= life_.interface_wear_limit)
  {
    return EndOfLife::INTERFACE_WEAR;
  }
  if (age.flaw_depth >= gear_.rim_thickness)
  {
    return EndOfLife::ROOT_CRACK;
  }
  if (spallSize(variation, age.bearing_turns) >= 1.0)
  {
    return EndOfLife::BEARING;
  }
  return std::nullopt;
}

DriveAgeing::Life DriveAgeing::live(const UnitVariation& variation, double hours, double every, bool grease_changes,
                                    const std::function<void(double, const DriveAge&)>& visit) const
{
  constexpr double TOLERANCE = 1e-8;  // of the limits
  constexpr int BISECTIONS = 50;
  namespace odeint = boost::numeric::odeint;
  const Scale scale(life_, gear_, variation);
  const auto rhs = [&](const Entries& entries, Entries& rate, double)
  { rate = scale.from(rates(variation, scale.to(entries))); };

  DriveAge age;
  age.flaw_depth = life_.flaw_depth;
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
      // The first instant at which anything stops; only one thing does so within a step this short.
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
    stepper.initialize(scale.from(age), end, std::max(1e-6, end - begin) + 1e-3 * end);
  }
}
}  // namespace hjt
