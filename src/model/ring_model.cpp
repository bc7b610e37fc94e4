// SPDX-License-Identifier: BSD-3-Clause
#include "model/ring_model.hpp"

namespace hjt
{
RingModel::RingModel(const Parameters& parameters)
  : gear(parameters.gear)
  , rest(parameters.gear)
  , tension(parameters.ring, rest)
  , bending(parameters.ring, rest)
  , contact(parameters.contact, parameters.gear, parameters.manufacture, parameters.bearing)
  , cup(parameters.cup, rest)
  , mesh(parameters.mesh, parameters.gear, ManufactureErrors(parameters.manufacture, parameters.gear))
{
}

void RingModel::forces(const RingShape& shape, const DrivePosition& position, RingForces& forces,
                       bool circular_spline_in) const noexcept
{
  forces.setZero();
  tension.addForces(shape, forces);
  bending.addForces(shape, forces);
  contact.addForces(shape, position, forces);
  cup.addForces(shape, forces);
  if (meshed && circular_spline_in)
  {
    mesh.addForces(shape, position, forces);
  }
}

void RingModel::tangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept
{
  tangent.setZero();
  tension.addTangent(shape, tangent);
  bending.addTangent(shape, forces, tangent);
  contact.addTangent(shape, forces, tangent);
  cup.addTangent(shape, forces, tangent);
  if (meshed)
  {
    mesh.addTangent(shape, forces, tangent);
  }
}

RingShape RingModel::restShape(const DrivePosition& position) const
{
  RingShape shape(rest.teeth());
  shape.points = rest.points();
  shape.updateGeometry();
  mesh.pairAtRest(position, shape);
  return shape;
}
}  // namespace hjt
