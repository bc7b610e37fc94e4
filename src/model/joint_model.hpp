// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elements/friction_laws.hpp"
#include "elements/load.hpp"
#include "elements/motor.hpp"
#include "elements/ring_friction.hpp"
#include "model/ring_model.hpp"

namespace hjt
{
/// External inputs of the joint, constant during a step.
struct JointInputs
{
  double load() const noexcept { return load_torque + arm_torque; }  ///< torque of load and arm on the output [N.m]

  double motor_torque{};  ///< wanted torque of the motor at 25 degC, within its torque limit [N.m]
  double load_torque{};   ///< external torque at the output; > 0 resists positive motion [N.m]
  bool brake_engaged{};
  double temperature{};  ///< temperature of the grease [degC]
  double arm_torque{};   ///< torque of the arm on the output at the end of the step; > 0 resists positive motion [N.m]
};

/// The whole joint: ring, motor, bearing, load and frictions. Only JointFaults changes it, in a copy of its own.
struct JointModel
{
  explicit JointModel(const Parameters& parameters);

  /// moments of inertia of motor and output [kg.m^2]
  Eigen::Vector2d inertia() const noexcept { return { motor.inertia(), load.inertia() }; }

  /// Energy stored in ring, gravity and cogging [J].
  double storedEnergy(const RingForces& forces, const DrivePosition& position) const noexcept
  {
    return storedEnergy(summary(forces), position);
  }
  double storedEnergy(const RingResponse& ring_response, const DrivePosition& position) const noexcept
  {
    return ring_response.energy + load.gravityEnergy(position.output_angle) +
           motor.coggingEnergy(position.wave_generator_angle);
  }

  /// Torques on motor and output, without friction [N.m]. `motor_torque`: torque of the motor without ripple.
  Eigen::Vector2d torque(const RingResponse& ring_response, const DrivePosition& position, double motor_torque,
                         double load_torque) const noexcept
  {
    const double angle = position.wave_generator_angle;
    return { motor.rippled(motor_torque, angle) + motor.coggingTorque(angle) + ring_response.wave_generator_torque,
             ring_response.output_torque + load.gravityTorque(position.output_angle) - load_torque };
  }

  static RingResponse summary(const RingForces& forces) noexcept
  {
    RingResponse response;
    response.energy = forces.energy;
    response.wave_generator_torque = forces.wave_generator_torque;
    response.output_torque = forces.output_torque;
    return response;
  }

  /// Quantities that determine the friction together with the state of the ring.
  struct Running
  {
    Eigen::Vector2d speeds;  ///< speeds of motor and output [rad/s]
    double brake_torque;     ///< holding torque of the brake at the motor [N.m]
    double viscosity;        ///< effective viscosity of the bearing's grease [m^2/s]
  };

  /// Friction torque of outer race and flexing rim at the motor shaft [N.m]. `running`: derivatives of the tooth points
  /// by the motor angle, at constant load [m/rad].
  double ringTorque(const RingShape& shape, const RingForces& forces, const Eigen::VectorXd& running) const noexcept
  {
    return interface_friction.torque(shape, forces.of<WaveGeneratorContact>(), running) +
           flexing_loss.torque(shape, forces.of<RimBending>(), running);
  }

  /// Computes all friction except that of a CupFriction with a state. `forces`: forces at the shape of `rates`;
  /// `velocity_ratio`: output speed over motor speed at constant load [-].
  void friction(const RingForces& forces, const RingRates& rates, double velocity_ratio, const Running& running,
                JointFriction& friction) const noexcept;

  /// Updates the friction of an unchanged ring to the speeds, brake torque and viscosity of `running`.
  void frictionAt(const Running& running, JointFriction& friction) const noexcept;

  /// Computes all friction from the RingFrictionResponse of a table. `cup_slip`: see CupFriction::addTerm.
  void friction(const RingFrictionResponse& ring_response, const Eigen::Vector2d& cup_slip, const Running& running,
                JointFriction& friction) const noexcept;

  /// Adds the dry friction of the output's bearing and seals.
  void addOutput(JointFriction& friction) const noexcept;

  RingModel ring;
  Motor motor;
  Load load;
  BearingFriction bearing;
  MeshFriction mesh_friction;
  CupFriction cup_friction;
  InterfaceFriction interface_friction;
  FlexingLoss flexing_loss;
  RingDamping damping;
  Brake brake;

private:
  double shaftStrength(const Running& running, double contact_force, double ring_torque,
                       JointFriction& friction) const noexcept;
};
}  // namespace hjt
