// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "life/drive_ageing.hpp"
#include "life/remaining_life.hpp"

namespace hjt
{
/// Wear of the nominal drive by a duty cycle, in closed form: loads per revolution of the new drive, grease that
/// ages.
class NominalUse
{
public:
  NominalUse(const DriveAgeing& ageing, const LifeParameters& life, bool grease_changes)
    : grease_factor_(life.grease_wear_factor)
    , grease_changes_(grease_changes)
    , flank_(FARTHEST * life.flank_wear_limit,
             [&](double depth)
             {
               DriveAge age;
               age.flank_wear = { depth, depth };
               return share(ageing.rates(nominalDrive(life), age).meanFlank(),
                            ageing.rates(nominalDrive(life), {}).meanFlank());
             })
    , interface_(FARTHEST * life.interface_wear_limit,
                 [&](double depth)
                 {
                   DriveAge age;
                   age.interface_wear = depth;
                   return share(ageing.rates(nominalDrive(life), age).interface_wear,
                                ageing.rates(nominalDrive(life), {}).interface_wear);
                 })
  {
    const DriveAge rate = ageing.rates(nominalDrive(life), {});
    hourly_ = { rate.worstFlank(), rate.meanFlank(), rate.interface_wear, rate.bearing_turns, {}, 0.0 };
    for (std::size_t i = 0; i < STRENGTHS; ++i)
    {
      hourly_.fatigue[i] = ageing.fatigueRates(strengthAt(i));
    }
    grease_rate_ = rate.grease;
    const double worse_side = rate.meanFlank() > 0.0 ? rate.worstFlank() / rate.meanFlank() : 1.0;
    flank_limit_ = worse_side * flank_.of(life.flank_wear_limit / worse_side);
    interface_limit_ = interface_.of(life.interface_wear_limit);
  }

  /// Depths as the loads of the new drive would have worn them, of the mean of both flanks and of the interface.
  const LoadFeedback& flank() const { return flank_; }
  const LoadFeedback& interface() const { return interface_; }

  /// From new
  Usage until(double hours) const
  {
    // Mean of the wear factor: grease of age g wears 1 + (factor - 1) g times as fast, g linear in time.
    const double age = grease_rate_ * hours;
    const double changes = grease_changes_ ? std::floor(age) : 0.0;
    const double left = age - changes;
    const double extra =
        grease_rate_ > 0.0 ? 0.5 * (grease_factor_ - 1.0) * (changes + left * left) / grease_rate_ : 0.0;
    const double fresh_hours = hours + extra;
    Usage usage{ hourly_.flank_wear * fresh_hours,
                 hourly_.mean_flank * fresh_hours,
                 hourly_.interface_wear * fresh_hours,
                 hourly_.bearing_turns * hours,
                 hourly_.fatigue,
                 age };
    for (auto& by_place : usage.fatigue)
    {
      for (double& damage : by_place)
      {
        damage *= hours;
      }
    }
    return usage;
  }

  /// `hours`: how far it looks; the use goes on as in its last stretch.
  FutureLoad from(double now, double hours, int stretches) const
  {
    FutureLoad future_load;
    future_load.step = hours / stretches;
    future_load.flank_limit = flank_limit_;
    future_load.interface_limit = interface_limit_;
    const Usage before = until(now);
    for (int i = 0; i <= stretches; ++i)
    {
      future_load.usage.push_back(until(now + i * future_load.step) - before);
    }
    return future_load;
  }

private:
  static constexpr double FARTHEST = 1.5;  // share of the limits

  static constexpr double SLOWEST = 1e-3;  // share of the new drive's rate: a depth that wears no longer stays defined

  /// Of two rates; 1 of a use that does not wear.
  static double share(double rate, double of) { return of > 0.0 ? std::max(rate / of, SLOWEST) : 1.0; }

  Usage hourly_;        // in fresh grease
  double grease_rate_;  // share of the grease's life by hour
  double grease_factor_;
  bool grease_changes_;
  LoadFeedback flank_;
  LoadFeedback interface_;
  double flank_limit_{};  // as the loads of the new drive would wear them [m]
  double interface_limit_{};
};
}  // namespace hjt
