// SPDX-License-Identifier: BSD-3-Clause
#include "model/joint_model.hpp"

#include "gear/vector_loops.hpp"

namespace hjt
{
JointModel::JointModel(const Parameters& parameters)
  : ring(parameters)
  , motor(parameters.motor)
  , load(parameters.output)
  , bearing(parameters.bearing)
  , mesh_friction(parameters.mesh, parameters.gear.teeth_flexspline)
  , cup_friction(parameters.cup)
  , interface_friction(parameters.contact)
  , flexing_loss(parameters.ring)
  , damping(parameters.ring, parameters.contact)
  , brake(parameters.brake)
{
}

/// Dry friction at the motor's shaft without that of the flanks [N.m]. Also sets JointFriction::presliding.
double JointModel::shaftStrength(const Running& running, double contact_force, double ring_torque,
                                 JointFriction& friction) const noexcept
{
  const double bearing_torque = bearing.torqueAtViscosity(running.speeds[0], contact_force, running.viscosity);
  const double sliding = motor.dryTorque(running.speeds[0]);
  const bool builds_up = motor.preslidingAngle() > 0.0;
  friction.presliding = builds_up ? sliding + bearing_torque + ring_torque : 0.0;
  return builds_up ? running.brake_torque : sliding + running.brake_torque + bearing_torque + ring_torque;
}

void JointModel::addOutput(JointFriction& friction) const noexcept
{
  const double strength = load.dryFriction();
  if (strength > 0.0)
  {
    friction.terms.push_back({ strength, { 0.0, 1.0 } });
  }
}

void JointModel::friction(const RingForces& forces, const RingRates& rates, double velocity_ratio,
                          const Running& running, JointFriction& friction) const noexcept
{
  const auto& contact = forces.of<WaveGeneratorContact>();
  friction.setZero();
  friction.running = rates.by_motor + velocity_ratio * rates.by_output;
  friction.contact_force = contact.force.sum();
  friction.ring_torque = ringTorque(rates.shape, forces, friction.running);
  friction.terms.push_back(
      { shaftStrength(running, friction.contact_force, friction.ring_torque, friction), { 1.0, 0.0 } });
  mesh_friction.addTerms(ring.of<ToothMesh>(), forces.of<ToothMesh>(), rates, running.speeds, friction);
  if (cup_friction.isTerm())
  {
    cup_friction.addTerm(rates.meanRotation(), friction);
  }
  addOutput(friction);
  friction.viscous(0, 0) += motor.viscousFriction();
  friction.viscous(1, 1) += load.viscousFriction();
  damping.add(contact, rates, friction);
}

void JointModel::frictionAt(const Running& running, JointFriction& friction) const noexcept
{
  friction.terms.setStrength(0, shaftStrength(running, friction.contact_force, friction.ring_torque, friction));
  mesh_friction.setStrengths(1, running.speeds, friction);
}

HJT_VECTOR_CLONES void JointModel::friction(const RingFrictionResponse& ring_response, const Eigen::Vector2d& cup_slip,
                                            const Running& running, JointFriction& friction) const noexcept
{
  friction.terms.clear();
  friction.terms.push_back(
      { shaftStrength(running, ring_response.contact_force, ring_response.ring_torque, friction), { 1.0, 0.0 } });
  using Groups = RingFrictionResponse::Groups;
  const Groups sliding =
      ring_response.rms_slip_by_motor * running.speeds[0] + ring_response.rms_slip_by_output * running.speeds[1];
  friction.terms.add(mesh_friction.coefficients(sliding), ring_response.flank_by_motor, ring_response.flank_by_output);
  cup_friction.addTerm(cup_slip, friction);
  addOutput(friction);
  const Eigen::Vector3d& dashpots = ring_response.viscous;
  friction.viscous << motor.viscousFriction() + dashpots[0], dashpots[1], dashpots[1],
      load.viscousFriction() + dashpots[2];
}
}  // namespace hjt
