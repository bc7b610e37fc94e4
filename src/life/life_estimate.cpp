// SPDX-License-Identifier: BSD-3-Clause
#include "life/life_estimate.hpp"

#include <algorithm>

#include "life/drive_ageing.hpp"
#include "life/nominal_use.hpp"

namespace hjt
{
namespace
{
constexpr int POSITIONS = 8;  // of the wave generator in a tooth pitch
constexpr int PARTICLES = 4000;
constexpr std::uint32_t SEED = 1;
constexpr int STRETCHES = 400;
constexpr double GREASE_CHANGES_AHEAD = 20.0;
constexpr bool GREASE_IS_CHANGED = true;
}  // namespace

LifeEstimator::LifeEstimator(const Parameters& parameters) : parameters_(parameters), load_map_(parameters, POSITIONS)
{
}

EndOfLife LifeEstimate::nearest() const
{
  return static_cast<EndOfLife>(std::max_element(used.begin(), used.end()) - used.begin());
}

LifeEstimate LifeEstimator::estimate(const UsageHistory& record)
{
  const LifeParameters& life = parameters_.life;
  const DutyCycle duty = record.duty();
  load_map_.cover(duty, {});
  const DriveAgeing ageing(life, parameters_.gear, duty, load_map_);
  const UnitVariation nominal = nominalDrive(life);
  LifeEstimate estimate;
  estimate.hours = record.hours();
  estimate.turns = record.turns();

  const DriveAge age = ageing.live(nominal, estimate.hours, estimate.hours, GREASE_IS_CHANGED, {}).age;
  const auto used = [&](EndOfLife limit) -> double& { return estimate.used[static_cast<std::size_t>(limit)]; };
  used(EndOfLife::FLANK_WEAR) = age.flank_wear / life.flank_wear_limit;
  used(EndOfLife::INTERFACE_WEAR) = age.interface_wear / life.interface_wear_limit;
  used(EndOfLife::ROOT_CRACK) = (age.flaw_depth - life.flaw_depth) / (parameters_.gear.rim_thickness - life.flaw_depth);
  used(EndOfLife::BEARING) = age.bearing_turns / (nominal.bearing_life * (1.0 + nominal.spall_growth));
  estimate.grease_used = age.grease;

  const NominalUse use(ageing, life, GREASE_IS_CHANGED);
  RemainingLife drives(life, PARTICLES, SEED);
  drives.use(use.until(estimate.hours));
  drives.survive();
  estimate.remaining =
      drives.remaining(use.from(estimate.hours, GREASE_CHANGES_AHEAD / ageing.rates(nominal, {}).grease, STRETCHES));
  return estimate;
}
}  // namespace hjt
