// SPDX-License-Identifier: BSD-3-Clause
#include "model/joint_model.hpp"

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
  , damping(parameters.ring, parameters.contact)
  , brake(parameters.brake)
{
}

/// Dry friction at the motor's shaft, flanks apart [N.m].
double JointModel::shaftTorque(const Running& running, double contact_force, double interface_torque) const noexcept
{
  return motor.coulombTorque() + running.brake_torque +
         bearing.torqueAtViscosity(running.speeds[0], contact_force, running.viscosity) + interface_torque;
}

void JointModel::friction(const RingForces& forces, const RingRates& rates, double velocity_ratio,
                          const Running& running, JointFriction& friction) const noexcept
{
  const auto& contact = forces.of<WaveGeneratorContact>();
  friction.setZero();
  friction.running = rates.by_motor + velocity_ratio * rates.by_output;
  const double interface_torque = interface_friction.torque(rates.shape, contact, friction.running);
  friction.terms.push_back({ shaftTorque(running, contact.force.sum(), interface_torque), { 1.0, 0.0 } });
  mesh_friction.addTerms(ring.of<ToothMesh>(), forces.of<ToothMesh>(), rates, running.speeds, friction);
  cup_friction.addTerm(rates, friction);
  friction.viscous(0, 0) += motor.viscousFriction();
  friction.viscous(1, 1) += load.viscousFriction();
  damping.add(contact, rates, friction);
}

void JointModel::friction(const RingFrictionResponse& ring_response, const Eigen::Vector2d& cup_slip,
                          const Running& running, JointFriction& friction) const noexcept
{
  friction.terms.clear();
  const double shaft = shaftTorque(running, ring_response.contact_force, ring_response.interface_torque);
  friction.terms.push_back({ shaft, { 1.0, 0.0 } });
  using Groups = RingFrictionResponse::Groups;
  const Groups sliding =
      ring_response.rms_slip_by_motor * running.speeds[0] + ring_response.rms_slip_by_output * running.speeds[1];
  const Groups coefficients = mesh_friction.coefficients(sliding);
  for (int i = 0; i < RingFrictionResponse::FLANK_GROUPS; ++i)
  {
    const Eigen::Vector2d slip(ring_response.flank_by_motor[i], ring_response.flank_by_output[i]);
    if (slip[0] != 0.0 || slip[1] != 0.0)
    {
      friction.terms.push_back({ coefficients[i], slip });
    }
  }
  cup_friction.addTerm(cup_slip, friction);
  const Eigen::Vector3d& dashpots = ring_response.viscous;
  friction.viscous << motor.viscousFriction() + dashpots[0], dashpots[1], dashpots[1],
      load.viscousFriction() + dashpots[2];
}
}  // namespace hjt
