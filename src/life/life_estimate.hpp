// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "life/drive_ageing.hpp"
#include "life/duty_cycle.hpp"
#include "life/read_wear.hpp"
#include "life/remaining_life.hpp"
#include "life/revolution_load_map.hpp"

namespace hjt
{
/// State of a drive and forecast of its life, computed from its record of use.
struct LifeEstimate
{
  double hours{};            ///< hours of use so far
  double turns{};            ///< turns of the wave generator so far
  RemainingHours remaining;  ///< remaining life of a drive that is still in use, if its use continues in the same way
  std::array<double, ENDS_OF_LIFE> used{};  ///< used share of each limit for the nominal drive [-]
  double grease_used{};                     ///< used share of the life of the present grease [-]

  double usedOf(EndOfLife limit) const { return used[static_cast<std::size_t>(limit)]; }

  EndOfLife nearest() const
  {
    return static_cast<EndOfLife>(std::max_element(used.begin(), used.end()) - used.begin());
  }
};

/// Ages a drive according to its record of use. Assumption: the grease is changed when due.
class LifeEstimator
{
public:
  explicit LifeEstimator(const Parameters& parameters)
    : parameters_(parameters)
    , fault_scale_(parameters.fault_scale)
    , load_map_(parameters, POSITIONS)
    , drives_(parameters)
  {
  }

  /// Estimates the remaining life. `record`: use so far, with at least one turn; `assessment`: assessment of the last
  /// compared window, null: none; `reference_hours`: hours of use at which the sound reference was learned, 0 for a new
  /// drive [h]; `read`: measured wear. The computation takes seconds for each load that was in no earlier record.
  /// @throws ParameterError if the ring has no equilibrium at one of the loads.
  LifeEstimate estimate(const UsageHistory& record, const Assessment* assessment, double reference_hours,
                        const ReadWear& read = {})
  {
    const LifeParameters& life = parameters_.life;
    const DutyCycle duty = record.duty();
    load_map_.cover(duty, {});
    const DriveAgeing ageing(parameters_, duty, load_map_);
    const UnitVariation nominal = nominalDrive(life);
    LifeEstimate estimate;
    estimate.hours = record.hours();
    estimate.turns = record.turns();

    const DriveAge age = ageing.live(nominal, estimate.hours, estimate.hours, GREASE_IS_CHANGED, {}).age;
    const auto used = [&](EndOfLife limit) -> double& { return estimate.used[static_cast<std::size_t>(limit)]; };
    used(EndOfLife::FLANK_WEAR) = age.worstFlank() / life.flank_wear_limit;
    used(EndOfLife::INTERFACE_WEAR) = age.interface_wear / life.interface_wear_limit;
    used(EndOfLife::ROOT_CRACK) =
        (age.flaw_depth - life.flaw_depth) / (parameters_.gear.rim_thickness - life.flaw_depth);
    used(EndOfLife::BEARING) = age.bearing_turns / (nominal.bearing_life * (1.0 + nominal.spall_growth));
    for (std::size_t place = 0; place < STRESS_PLACES; ++place)
    {
      used(fatigueAt(place)) = age.fatigue[place];
    }
    estimate.grease_used = age.grease;

    const NominalUse use(ageing, life, GREASE_IS_CHANGED);
    estimate.remaining =
        drives_.remaining(use.until(estimate.hours),
                          use.from(estimate.hours, GREASE_CHANGES_AHEAD / ageing.rates(nominal, {}).grease, STRETCHES),
                          assessment, use.until(reference_hours), trendsOf(read, use, fault_scale_, reference_hours));
    return estimate;
  }

private:
  static constexpr int POSITIONS = 8;                   // positions of the wave generator in a tooth pitch
  static constexpr int STRETCHES = 400;                 // number of intervals of the future use
  static constexpr double GREASE_CHANGES_AHEAD = 20.0;  // length of the future use, in lives of the grease
  static constexpr bool GREASE_IS_CHANGED = true;

  AgeingParameters parameters_;
  FaultScaleParameters fault_scale_;
  RevolutionLoadMap load_map_;
  RemainingLife drives_;
};
}  // namespace hjt
