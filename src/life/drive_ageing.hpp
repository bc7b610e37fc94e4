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
/// The drive that the parameters describe: no factors, the median bearing.
UnitVariation nominalDrive(const LifeParameters& parameters);

/// A drive's use over years: the laws of ageing along a duty cycle, fed by the loads per revolution of the tooth model.
class DriveAgeing
{
public:
  DriveAgeing(const AgeingParameters& parameters, const DutyCycle& duty, const RevolutionLoadMap& load_map)
    : parameters_(parameters), fatigue_law_(parameters.life, parameters.stress), duty_(duty), load_map_(load_map)
  {
  }

  /// Change of the age by hour, at an age.
  DriveAge rates(const UnitVariation& variation, const DriveAge& age) const;

  /// Miner's sums by hour of a new drive whose fatigue strength is `strength` times the median's.
  std::array<double, STRESS_PLACES> fatigueRates(double strength) const;

  /// The first limit that an age has reached.
  std::optional<EndOfLife> ended(const UnitVariation& variation, const DriveAge& age) const;

  struct Life
  {
    double hours{};                ///< until the end of use, or the requested time
    std::optional<EndOfLife> end;  ///< none: still in use
    DriveAge age;
  };

  /// Ages a new drive up to `hours`, or to the end of use if that comes first. `visit(hours, age)` at every multiple of
  /// `every` hours and at the end. `grease_changes`: the grease is changed when it is due. Runge-Kutta of Dormand and
  /// Prince with its own steps, 1e-8 of the limits.
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
