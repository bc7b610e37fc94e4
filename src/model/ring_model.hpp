// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "elements/cup_torsion.hpp"
#include "elements/rim_bending.hpp"
#include "elements/rim_tension.hpp"
#include "elements/ring_forces.hpp"
#include "elements/tooth_mesh.hpp"
#include "elements/wave_generator_contact.hpp"
#include "gear/ring_shape.hpp"
#include "gear/tooth_ring.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// All conservative elements on the ring. Faults edit it between steps.
struct RingModel
{
  /// @throws ParameterError on a bad table of pitch errors.
  explicit RingModel(const Parameters& parameters);

  /// Forces and stored energy; of the teeth too unless the circular spline is not in yet. The shape's geometry must be up
  /// to date.
  void forces(const RingShape& shape, const DrivePosition& position, RingForces& forces,
              bool circular_spline_in = true) const noexcept;

  /// Hessian of the stored energy; `forces` of the same shape.
  void tangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept;

  /// The ring at rest, every tooth paired with its nearest space.
  RingShape restShape(const DrivePosition& position) const;

  GearParameters gear;
  ToothRing rest;
  RimTension tension;
  RimBending bending;
  WaveGeneratorContact contact;
  CupTorsion cup;
  ToothMesh mesh;
  bool meshed{ true };  ///< false: circular spline left out
};
}  // namespace hjt
