// SPDX-License-Identifier: BSD-3-Clause
#include "life/revolution_load_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.hpp"
#include "base/range.hpp"
#include "elements/race_deflection.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "statics/gear_rules.hpp"

namespace hjt
{
namespace
{
void widen(Range& range, double value)
{
  range = { std::min(range.min, value), std::max(range.max, value) };
}

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

/// Loads whose numbers are the larger magnitudes of the corresponding numbers of `a` and `b`.
RevolutionLoad larger(const RevolutionLoad& a, const RevolutionLoad& b)
{
  return combined(a, b, [](double x, double y) { return std::max(std::abs(x), std::abs(y)); });
}
}  // namespace

RaceCreep::RaceCreep(const Parameters& parameters)
  : lever_(parameters.contact.slip_lever)
  , radius_(parameters.gear.flexspline_inner_radius)
  , fit_(raceFit(parameters))
  , rest_length_(segmentLength(parameters.gear))
{
}

RaceCreep::Rates RaceCreep::at(const RingEquilibrium& ring, const Eigen::VectorXd& running)
{
  const RingShape& shape = ring.shape();
  const Eigen::VectorXd& force = ring.forces().of<WaveGeneratorContact>().force;
  const Eigen::VectorXd& gap = ring.model().of<WaveGeneratorContact>().gap();
  double total = 0.0;
  slips_.clear();
  for (int i = 0; i < shape.solved; ++i)
  {
    if (force[i] <= 0.0)
    {
      continue;
    }
    const int h = shape.previous(i);
    const int j = shape.next(i);
    const Eigen::Vector2d chord = shape.points.segment<2>(2 * j) - shape.points.segment<2>(2 * h);
    const Eigen::Vector2d rate = running.segment<2>(2 * j) - running.segment<2>(2 * h);
    const double tilt = (chord.y() * rate.x() - chord.x() * rate.y()) / chord.squaredNorm();
    const double strain = (shape.lengths[h] + shape.lengths[i]) / (2.0 * rest_length_) - 1.0;
    slips_.push_back({ lever_ * tilt - radius_ * strain + fit_ - gap[i], force[i] });
    total += force[i];
  }
  std::sort(slips_.begin(), slips_.end(), [](const Slip& a, const Slip& b) { return a.rate < b.rate; });
  Rates rates;
  double below = 0.0;
  for (const Slip& slip : slips_)
  {
    below += slip.force;
    if (below >= 0.5 * total)
    {
      rates.advance = slip.rate;
      break;
    }
  }
  for (const Slip& slip : slips_)
  {
    rates.sliding += shape.copies() * slip.force * std::abs(slip.rate - rates.advance);
  }
  return rates;
}

RevolutionLoadAnalysis::RevolutionLoadAnalysis(const JointModel& joint, const SolverParameters& solver,
                                               const FlexsplineStress& stress, const RaceCreep& creep, int positions)
  : positions_(positions)
  , walk_(joint, solver, positions)
  , flexspline_stress_(stress)
  , tooth_stress_(joint.ring.gear.teeth_flexspline)
  , race_creep_(creep)
  , running_(2 * joint.ring.gear.teeth_flexspline)
{
  if (!walk_.status().ok())
  {
    throw ParameterError(explanationOf(walk_.status()));
  }
}

RevolutionLoad RevolutionLoadAnalysis::under(double load_torque)
{
  const int teeth = walk_.model().ring.gear.teeth_flexspline;
  const double step = TWO_PI / teeth / positions_;  // step of the wave generator [rad]
  RevolutionLoad revolution_load;
  constexpr double NONE = std::numeric_limits<double>::infinity();
  revolution_load.stress.fill({ NONE, -NONE, 0.0 });
  Range bending{ NONE, -NONE };
  Range tension{ NONE, -NONE };
  walk_.under(load_torque,
              [&](double velocity_ratio)
              {
                const JointModel& model = walk_.model();
                const RingEquilibrium& ring = walk_.ring();
                running_ = ring.byWaveGenerator() + velocity_ratio * ring.byOutput();
                for (const FlankContact& contact : ring.forces().of<ToothMesh>().flanks)
                {
                  revolution_load.flank_sliding += step * ring.shape().copies() *
                                                   std::abs(ring.forces().of<ToothMesh>().flank_force[contact.tooth] *
                                                            model.ring.of<ToothMesh>().slidingSpeed(
                                                                ring.shape(), contact, running_, velocity_ratio));
                }
                flexspline_stress_.at(ring, 0, tooth_stress_);
                for (std::size_t place = 0; place < STRESS_PLACES; ++place)
                {
                  StressCycle& cycle = revolution_load.stress[place];
                  const StressCycle now = tooth_stress_.cycle(place);
                  cycle = { std::min(cycle.lowest, now.lowest), std::max(cycle.highest, now.highest),
                            std::max(cycle.shear, now.shear) };
                }
                for (int i = 0; i < teeth; ++i)
                {
                  const FlexsplineStress::Parts parts = flexspline_stress_.inToothSpace(ring, i);
                  widen(bending, parts.bending);
                  widen(tension, parts.tension);
                }
                const RaceCreep::Rates creep = race_creep_.at(ring, running_);
                revolution_load.interface_sliding += step * teeth * creep.sliding;
                revolution_load.race_creep += step * teeth * creep.advance;
              });
  if (!walk_.status().ok())
  {
    throw ParameterError("there is no equilibrium under a load of " + numberText(load_torque) +
                         " N.m: " + explanationOf(walk_.status()));
  }
  revolution_load.bending_range = bending.max - bending.min;
  revolution_load.tension_range = tension.max - tension.min;
  return revolution_load;
}

/// Analysis of the drive with the flank and interface wear of `age`.
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
