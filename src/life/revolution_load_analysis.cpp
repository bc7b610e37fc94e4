// SPDX-License-Identifier: BSD-3-Clause
#include "life/revolution_load_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.hpp"
#include "base/range.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
void widen(Range& range, double value)
{
  range = { std::min(range.min, value), std::max(range.max, value) };
}
}  // namespace

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
  const double step = TWO_PI / teeth / positions_;  // of the wave generator [rad]
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
    throw ParameterError("no equilibrium under a load of " + numberText(load_torque) +
                         " N.m: " + explanationOf(walk_.status()));
  }
  revolution_load.bending_range = bending.max - bending.min;
  revolution_load.tension_range = tension.max - tension.min;
  return revolution_load;
}
}  // namespace hjt
