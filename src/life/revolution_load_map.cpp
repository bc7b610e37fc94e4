// SPDX-License-Identifier: BSD-3-Clause
#include "life/revolution_load_map.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
RevolutionLoad blend(const RevolutionLoad& a, const RevolutionLoad& b, double share)
{
  return combined(a, b, [share](double from, double to) { return from + share * (to - from); });
}

struct Cell
{
  std::size_t index;
  double share;
};

Cell cellOf(double value, double step, int stages)
{
  const double place = std::clamp(value / step, 0.0, static_cast<double>(stages - 1));
  const int index = std::min(static_cast<int>(place), stages - 2);
  return { static_cast<std::size_t>(index), place - index };
}

/// Entry by entry, in magnitude.
RevolutionLoad larger(const RevolutionLoad& a, const RevolutionLoad& b)
{
  return combined(a, b, [](double x, double y) { return std::max(std::abs(x), std::abs(y)); });
}
}  // namespace

/// Of the drive with the wear of its age.
RevolutionLoadAnalysis RevolutionLoadMap::analysisOf(const DriveAge& age) const
{
  FaultList faults = faults_at_start_;
  faults.set({ FaultKind::TOOTH_WEAR, age.meanFlank() / fault_scale_.tooth_wear_depth }, 0);
  faults.set({ FaultKind::INTERFACE_WEAR, age.interface_wear / fault_scale_.interface_wear_depth }, 0);
  JointFaults worn = joint_;
  worn.apply(faults);
  return { worn.model(), solver_, stress_, creep_, positions_ };
}

RevolutionLoadMap::RevolutionLoadMap(const Parameters& parameters, int positions)
  : joint_(parameters)
  , faults_at_start_(faultsAtStart(parameters))
  , fault_scale_(parameters.fault_scale)
  , solver_(parameters.solver)
  , stress_(parameters)
  , creep_(parameters)
  , positions_(positions)
  , flank_step_(parameters.life.flank_wear_limit / (STAGES - 1))
  , interface_step_(parameters.life.interface_wear_limit / (STAGES - 1))
{
}

void RevolutionLoadMap::cover(const DutyCycle& duty, const std::function<void(double)>& progress)
{
  std::map<double, Stages> added;
  for (const DutyPhase& phase : duty.phases)
  {
    const double load = std::abs(phase.load_torque);
    if (nodes_.count(load) == 0)
    {
      added[load] = {};
    }
  }
  if (added.empty())
  {
    return;
  }
  for (int flank = 0; flank < STAGES; ++flank)
  {
    for (int interface = 0; interface < STAGES; ++interface)
    {
      DriveAge age;
      age.flank_wear.fill(flank * flank_step_);
      age.interface_wear = interface * interface_step_;
      RevolutionLoadAnalysis analysis = analysisOf(age);
      for (auto& [load, stages] : added)
      {
        stages[static_cast<std::size_t>(flank)][static_cast<std::size_t>(interface)] = analysis.under(load);
      }
      if (progress)
      {
        progress((flank * STAGES + interface + 1.0) / (STAGES * STAGES));
      }
    }
  }
  nodes_.merge(added);
}

RevolutionLoad RevolutionLoadMap::at(double load_torque, double flank_wear, double interface_wear) const
{
  const Cell flank = cellOf(flank_wear, flank_step_, STAGES);
  const Cell interface = cellOf(interface_wear, interface_step_, STAGES);
  const Stages& stages = nodes_.at(std::abs(load_torque));
  const auto along = [&](std::size_t row)
  { return blend(stages[row][interface.index], stages[row][interface.index + 1], interface.share); };
  return blend(along(flank.index), along(flank.index + 1), flank.share);
}

double RevolutionLoadMap::largestError() const
{
  RevolutionLoad miss;
  RevolutionLoad largest;
  for (int flank = 0; flank < STAGES - 1; ++flank)
  {
    for (int interface = 0; interface < STAGES - 1; ++interface)
    {
      DriveAge age;
      age.flank_wear.fill((flank + 0.5) * flank_step_);
      age.interface_wear = (interface + 0.5) * interface_step_;
      RevolutionLoadAnalysis analysis = analysisOf(age);
      for (const auto& [load, stages] : nodes_)
      {
        const RevolutionLoad measured = analysis.under(load);
        const RevolutionLoad mapped = at(load, age.meanFlank(), age.interface_wear);
        largest = larger(largest, measured);
        miss = larger(miss, combined(mapped, measured, std::minus<>()));
      }
    }
  }
  constexpr auto TOOTH_SPACE = static_cast<std::size_t>(StressPlace::TOOTH_SPACE);
  return std::max({ miss.flank_sliding / largest.flank_sliding, miss.interface_sliding / largest.interface_sliding,
                    miss.stress[TOOTH_SPACE].highest / largest.stress[TOOTH_SPACE].highest });
}
}  // namespace hjt
