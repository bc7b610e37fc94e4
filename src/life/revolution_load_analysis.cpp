// SPDX-License-Identifier: BSD-3-Clause
#include "life/revolution_load_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/variants.hpp"

namespace hjt
{
RevolutionLoadAnalysis::RevolutionLoadAnalysis(const Parameters& parameters, int positions)
  : parameters_(parameters)
  , positions_(positions)
  , walk_(parameters, positions)
  , interface_(withUnitFriction(parameters).contact)
  , running_(2 * parameters.gear.teeth_flexspline)
{
  if (!walk_.status().ok())
  {
    throw ParameterError(explanationOf(walk_.status()));
  }
}

/// Stress of the rim's outer fibre, where the teeth stand, at tooth i: bending by the change of its curvature, and the
/// tension of the segment behind it [Pa].
double RevolutionLoadAnalysis::rimStress(int i) const
{
  const RingShape& shape = walk_.ring().shape();
  const RingModel& ring = walk_.model().ring;
  const int h = shape.previous(i);
  const double turn = std::atan2(
      shape.directions[2 * h] * shape.directions[2 * i + 1] - shape.directions[2 * h + 1] * shape.directions[2 * i],
      shape.directions[2 * h] * shape.directions[2 * i] + shape.directions[2 * h + 1] * shape.directions[2 * i + 1]);
  const double curvature = (turn - ring.rest.pitchAngle()) / ring.rest.segmentLength();
  const double section = parameters_.life.face_width * parameters_.gear.rim_thickness;
  return 0.5 * parameters_.gear.rim_thickness * parameters_.life.elastic_modulus * curvature +
         ring.of<RimTension>().tension(shape, i) / section;
}

RevolutionLoad RevolutionLoadAnalysis::under(double load_torque)
{
  const int teeth = parameters_.gear.teeth_flexspline;
  const double step = TWO_PI / teeth / positions_;  // of the wave generator [rad]
  RevolutionLoad revolution_load;
  double highest = std::numeric_limits<double>::lowest();
  double lowest = std::numeric_limits<double>::max();
  walk_.under(
      load_torque,
      [&](double velocity_ratio)
      {
        const JointModel& model = walk_.model();
        const RingEquilibrium& ring = walk_.ring();
        running_ = ring.byWaveGenerator() + velocity_ratio * ring.byOutput();
        for (const FlankContact& contact : ring.forces().of<ToothMesh>().flanks)
        {
          revolution_load.flank_sliding +=
              step * std::abs(ring.forces().of<ToothMesh>().flank_force[contact.tooth] *
                              model.ring.of<ToothMesh>().slidingSpeed(ring.shape(), contact, running_, velocity_ratio));
        }
        for (int i = 0; i < teeth; ++i)
        {
          const double stress = rimStress(i);
          highest = std::max(highest, stress);
          lowest = std::min(lowest, stress);
        }
        revolution_load.interface_sliding +=
            step * teeth * interface_.torque(ring.shape(), ring.forces().of<WaveGeneratorContact>(), running_);
      });
  if (!walk_.status().ok())
  {
    throw ParameterError("no equilibrium under a load of " + numberText(load_torque) +
                         " N.m: " + explanationOf(walk_.status()));
  }
  revolution_load.rim_stress_range = highest - lowest;
  return revolution_load;
}
}  // namespace hjt
