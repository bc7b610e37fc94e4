// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "life/drive_ageing.hpp"
#include "life/remaining_life.hpp"

namespace hjt
{
/// What a duty cycle does to the nominal drive, in closed form: loads per revolution of the new drive, grease that
/// ages.
class NominalUse
{
public:
  NominalUse(const DriveAgeing& ageing, const LifeParameters& life, bool grease_changes)
    : grease_factor_(life.grease_wear_factor), grease_changes_(grease_changes)
  {
    const DriveAge rate = ageing.rates(nominalDrive(life), {});
    hourly_ = { rate.worstFlank(), rate.meanFlank(), rate.interface_wear, rate.bearing_turns, {} };
    for (std::size_t i = 0; i < STRENGTHS; ++i)
    {
      hourly_.fatigue[i] = ageing.fatigueRates(strengthAt(life, i));
    }
    grease_rate_ = rate.grease;
  }

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
    Usage usage{ hourly_.flank_wear * fresh_hours, hourly_.mean_flank * fresh_hours,
                 hourly_.interface_wear * fresh_hours, hourly_.bearing_turns * hours, hourly_.fatigue };
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
    const Usage before = until(now);
    for (int i = 0; i <= stretches; ++i)
    {
      future_load.usage.push_back(until(now + i * future_load.step) - before);
    }
    return future_load;
  }

private:
  Usage hourly_;        // in fresh grease
  double grease_rate_;  // share of the grease's life by hour
  double grease_factor_;
  bool grease_changes_;
};
}  // namespace hjt
