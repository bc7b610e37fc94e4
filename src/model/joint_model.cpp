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
  , brake_torque(parameters.brake.holding_torque)
{
}

void JointModel::friction(const RingShape& shape, const RingForces& forces, const RingRates& rates, double follow,
                          const Eigen::Vector2d& speeds, const JointInputs& inputs, double viscosity,
                          Eigen::VectorXd& running, JointFriction& friction) const noexcept
{
  friction.setZero();
  running = rates.by_motor + follow * rates.by_output;
  const double shaft = motor.coulombTorque() + (inputs.brake_engaged ? brake_torque : 0.0) +
                       bearing.torqueAtViscosity(speeds[0], forces.contact_force.sum(), viscosity) +
                       interface_friction.torque(shape, forces, running);
  friction.terms.push_back({ shaft, { 1.0, 0.0 } });
  mesh_friction.addTerms(ring.mesh, shape, forces, rates, speeds, friction);
  cup_friction.addTerm(shape, rates, friction);
  friction.viscous(0, 0) += motor.viscousFriction();
  friction.viscous(1, 1) += load.viscousFriction();
  damping.add(shape, forces, rates, friction);
}

void JointModel::friction(const RingFrictionResponse& ring_response, const Eigen::Vector2d& cup_slip,
                          const Eigen::Vector2d& speeds, const JointInputs& inputs, double viscosity,
                          JointFriction& friction) const noexcept
{
  friction.terms.clear();
  const double shaft = motor.coulombTorque() + (inputs.brake_engaged ? brake_torque : 0.0) +
                       bearing.torqueAtViscosity(speeds[0], ring_response.contact_force, viscosity) +
                       ring_response.interface_torque;
  friction.terms.push_back({ shaft, { 1.0, 0.0 } });
  using Groups = RingFrictionResponse::Groups;
  const Groups sliding = ring_response.rms_slip_by_motor * speeds[0] + ring_response.rms_slip_by_output * speeds[1];
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
