// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "solver/joint_dynamics.hpp"

namespace hjt
{
/// Copies forces and positions of a ring, turned by `shift` pitches: tooth i + `shift` gets the values of tooth i.
inline void fillToothForces(const RingEquilibrium& ring, int shift, ToothForces& out) noexcept
{
  const RingModel& model = ring.model();
  const RingForces& forces = ring.forces();
  const RingShape& shape = ring.shape();
  const double angle = shift * model.rest.pitchAngle();
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  auto place = static_cast<std::size_t>(shift % shape.teeth());
  for (int i = 0; i < shape.teeth(); ++i, place = place + 1 < out.mesh_force.size() ? place + 1 : 0)
  {
    const double x = shape.points[2 * i];
    const double y = shape.points[2 * i + 1];
    out.wave_generator_force[place] = forces.of<WaveGeneratorContact>().force[i];
    out.rim_tension[place] = model.of<RimTension>().tension(shape, i);
    out.bending_force[place] = model.of<RimBending>().bendingForce(shape, forces.of<RimBending>(), i);
    out.mesh_force[place] = forces.of<ToothMesh>().flank_force[i];
    out.tooth_x[place] = cosine * x - sine * y;
    out.tooth_y[place] = sine * x + cosine * y;
  }
}

/// Interpolates forces and positions of the teeth at the joint's present angles in the surface's ToothResponse.
/// @returns false if the joint uses no surface with a ToothResponse.
inline bool fillToothForces(const JointDynamics& joint, ToothForces& out) noexcept
{
  const ResponseSurface* surface = joint.surface();
  if (!joint.onSurface() || !surface->hasTeeth())
  {
    return false;
  }
  // The order of the arrays is that of ToothResponse::Quantity.
  const std::array<double*, ToothResponse::QUANTITIES> arrays{
    out.wave_generator_force.data(), out.rim_tension.data(), out.bending_force.data(),
    out.mesh_force.data(),           out.tooth_x.data(),     out.tooth_y.data(),
  };
  const DrivePosition now = joint.position();
  return surface->table().teeth.at(now.wave_generator_angle, now.output_angle, arrays.data());
}

/// Ring at the joint's present angles, for the output of tooth forces.
///
/// While the joint uses the response surface, the joint's ring stays at an earlier position. A second ring moves to the
/// present angles, so that the output does not change the simulation. Only construction allocates.
class ObservedRing
{
public:
  /// `model` must outlive this object.
  ObservedRing(const RingModel& model, const SolverParameters& parameters) : ring_(model, parameters) {}

  void setModel(const RingModel& copied) noexcept { ring_.setModel(copied); }  ///< see RingEquilibrium::setModel

  /// Must be called after a reset of the joint or a change of its model.
  void restart() noexcept { started_ = false; }

  /// Ring in equilibrium at the joint's present angles, valid until the joint's next step; null without equilibrium.
  const RingEquilibrium* at(const JointDynamics& joint) noexcept
  {
    if (!joint.onSurface())
    {
      return &joint.ring();
    }
    // The second ring starts from the joint's ring, which is in equilibrium at an earlier position.
    started_ = started_ || ring_.solveFrom(joint.ring().shape().points, joint.ring().position()).ok();
    return started_ && ring_.moveTo(joint.position()).ok() ? &ring_ : nullptr;
  }

private:
  RingEquilibrium ring_;
  bool started_{};
};
}  // namespace hjt
