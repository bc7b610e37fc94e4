// SPDX-License-Identifier: BSD-3-Clause
#include "life/revolution_load_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/variants.hpp"
#include "statics/pitch_walk.hpp"

namespace hjt
{
struct RevolutionLoadAnalysis::Impl
{
  Impl(const Parameters& p, int positions)
    : parameters(p)
    , positions(positions)
    , walk(p, positions)
    , interface(withUnitFriction(p).contact)
    , running(2 * p.gear.teeth_flexspline)
  {
  }

  /// Stress of the rim's outer fibre, where the teeth stand, at tooth i: bending by the change of its curvature, and
  /// the tension of the segment behind it [Pa].
  double rimStress(int i) const
  {
    const RingShape& shape = walk.ring().shape();
    const RingModel& ring = walk.model().ring;
    const int h = shape.previous(i);
    const double turn = std::atan2(
        shape.directions[2 * h] * shape.directions[2 * i + 1] - shape.directions[2 * h + 1] * shape.directions[2 * i],
        shape.directions[2 * h] * shape.directions[2 * i] + shape.directions[2 * h + 1] * shape.directions[2 * i + 1]);
    const double curvature = (turn - ring.rest.pitchAngle()) / ring.rest.segmentLength();
    const double section = parameters.life.face_width * parameters.gear.rim_thickness;
    return 0.5 * parameters.gear.rim_thickness * parameters.life.elastic_modulus * curvature +
           ring.of<RimTension>().tension(shape, i) / section;
  }

  Parameters parameters;
  int positions;
  PitchWalk walk;
  InterfaceFriction interface;
  Eigen::VectorXd running;
};

RevolutionLoadAnalysis::RevolutionLoadAnalysis(const Parameters& parameters, int positions)
  : impl_(std::make_unique<Impl>(parameters, positions))
{
  if (!impl_->walk.status().ok())
  {
    throw ParameterError(explanationOf(impl_->walk.status()));
  }
}

RevolutionLoadAnalysis::~RevolutionLoadAnalysis() = default;

RevolutionLoad RevolutionLoadAnalysis::under(double load_torque)
{
  Impl& impl = *impl_;
  const int teeth = impl.parameters.gear.teeth_flexspline;
  const double step = TWO_PI / teeth / impl.positions;  // of the wave generator [rad]
  RevolutionLoad revolution_load;
  double highest = std::numeric_limits<double>::lowest();
  double lowest = std::numeric_limits<double>::max();
  impl.walk.under(
      load_torque,
      [&](double velocity_ratio)
      {
        const JointModel& model = impl.walk.model();
        const RingEquilibrium& ring = impl.walk.ring();
        impl.running = ring.byWaveGenerator() + velocity_ratio * ring.byOutput();
        for (const FlankContact& contact : ring.forces().of<ToothMesh>().flanks)
        {
          revolution_load.flank_sliding += step * std::abs(ring.forces().of<ToothMesh>().flank_force[contact.tooth] *
                                                           model.ring.of<ToothMesh>().slidingSpeed(
                                                               ring.shape(), contact, impl.running, velocity_ratio));
        }
        for (int i = 0; i < teeth; ++i)
        {
          const double stress = impl.rimStress(i);
          highest = std::max(highest, stress);
          lowest = std::min(lowest, stress);
        }
        revolution_load.interface_sliding +=
            step * teeth * impl.interface.torque(ring.shape(), ring.forces().of<WaveGeneratorContact>(), impl.running);
      });
  if (!impl.walk.status().ok())
  {
    throw ParameterError("no equilibrium under a load of " + numberText(load_torque) +
                         " N.m: " + explanationOf(impl.walk.status()));
  }
  revolution_load.rim_stress_range = highest - lowest;
  return revolution_load;
}
}  // namespace hjt
