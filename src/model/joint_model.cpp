// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/model/joint_model.hpp"

namespace hjt
{
JointModel::JointModel(const Parameters& parameters)
  : ring(parameters)
  , motor(parameters.motor)
  , load(parameters.output)
  , bearing(parameters.bearing)
  , mesh_friction(parameters.mesh)
  , cup_friction(parameters.cup)
  , interface_friction(parameters.contact)
  , damping(parameters.ring, parameters.contact)
  , brake_torque(parameters.brake.holding_torque)
{
}

void JointModel::friction(const RingShape& shape, const DrivePosition& position, const RingForces& forces,
                          const RingRates& rates, double follow, const Eigen::Vector2d& speeds,
                          const JointInputs& inputs, Eigen::VectorXd& running, JointFriction& friction) const noexcept
{
  friction.setZero();
  running = rates.by_motor + follow * rates.by_output;
  const double shaft = motor.coulombTorque() + (inputs.brake_engaged ? brake_torque : 0.0) +
                       bearing.torque(speeds[0], forces.contact_force.sum(), inputs.temperature) +
                       interface_friction.torque(shape, forces, running);
  friction.terms.push_back({ shaft, { 1.0, 0.0 } });
  mesh_friction.addTerms(ring.mesh, shape, position, forces, rates, speeds, friction);
  cup_friction.addTerm(shape, rates, friction);
  friction.viscous(0, 0) += motor.viscousFriction();
  friction.viscous(1, 1) += load.viscousFriction();
  damping.add(shape, forces, rates, friction);
}
}  // namespace hjt
