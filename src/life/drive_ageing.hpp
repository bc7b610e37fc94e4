// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "life/ageing_laws.hpp"
#include "life/drive_age.hpp"
#include "life/duty_cycle.hpp"
#include "life/revolution_load_map.hpp"

namespace hjt
{
/// The drive that the parameters describe: no factors, the median bearing.
UnitVariation nominalDrive(const LifeParameters& parameters);

/// A drive's use over years: the laws of ageing along a duty cycle, fed by the loads per revolution of the tooth model.
class DriveAgeing
{
public:
  DriveAgeing(const LifeParameters& life, const GearParameters& gear, const DutyCycle& duty,
              const RevolutionLoadMap& load_map)
    : life_(life), gear_(gear), duty_(duty), load_map_(load_map), turns_per_hour_(duty.turnsPerHour())
  {
  }

  /// Change of the age by hour, at an age.
  DriveAge rates(const UnitVariation& variation, const DriveAge& age) const;

  /// The first limit that an age has reached.
  std::optional<EndOfLife> ended(const UnitVariation& variation, const DriveAge& age) const;

  struct Life
  {
    double hours{};                ///< until the end of use, or the requested time
    std::optional<EndOfLife> end;  ///< none: still in use
    DriveAge age;
  };

  /// From new: up to `hours`, or to the end of use if that comes first. `visit(hours, age)` at every multiple of
  /// `every` hours and at the end. `grease_changes`: the grease is changed when it is due. Runge-Kutta of Dormand and
  /// Prince with its own steps, 1e-8 of the limits.
  Life live(const UnitVariation& variation, double hours, double every, bool grease_changes,
            const std::function<void(double, const DriveAge&)>& visit) const;

private:
  LifeParameters life_;
  GearParameters gear_;
  DutyCycle duty_;
  const RevolutionLoadMap& load_map_;
  double turns_per_hour_;
};
}  // namespace hjt
