// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "life/ageing_laws.hpp"
#include "life/duty_cycle.hpp"
#include "life/revolution_load_map.hpp"
#include "statics/flexspline_stress.hpp"

namespace hjt
{
/// The nominal drive: all factors are 1, and its bearing has the median life.
UnitVariation nominalDrive(const LifeParameters& parameters);

/// Integrates the laws of ageing over years of a duty cycle. `load_map` gives the loads of one turn by the tooth model.
class DriveAgeing
{
public:
  DriveAgeing(const AgeingParameters& parameters, const DutyCycle& duty, const RevolutionLoadMap& load_map)
    : parameters_(parameters), fatigue_law_(parameters.life, parameters.stress), duty_(duty), load_map_(load_map)
  {
  }

  /// Change of each field of DriveAge in an hour, for a drive with the age `age`.
  DriveAge rates(const UnitVariation& variation, const DriveAge& age) const;

  /// Increase of a new drive's Miner's sums by place [1/h]. `strength`: fatigue strength over the median of all drives.
  std::array<double, STRESS_PLACES> fatigueRates(double strength) const;

  /// The first limit that a drive of this age has reached; empty: none.
  std::optional<EndOfLife> ended(const UnitVariation& variation, const DriveAge& age) const;

  struct Life
  {
    double hours{};                ///< hours of use until the end of use or, without an end, the requested hours
    std::optional<EndOfLife> end;  ///< reason for the end of use; empty if the drive is still in use
    DriveAge age;                  ///< age of the drive after `hours`
  };

  /// Ages a new drive for `hours`, or until the end of use. The function calls `visit(hours, age)` at every multiple of
  /// `every` hours and at the end. `grease_changes`: whether the grease is changed when due. The integrator is the
  /// Runge-Kutta method of Dormand and Prince with step control, tolerance 1e-8 of the limits.
  Life live(const UnitVariation& variation, double hours, double every, bool grease_changes,
            const std::function<void(double, const DriveAge&)>& visit) const;

private:
  void addFatigue(double turns, const RevolutionLoad& revolution_load, const UnitVariation& variation,
                  std::array<MinerSum, STRESS_PLACES>& fatigue) const;

  AgeingParameters parameters_;
  FatigueLaw fatigue_law_;
  DutyCycle duty_;
  const RevolutionLoadMap& load_map_;
};
}  // namespace hjt
