// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/model/joint_model.hpp"
#include "harmonic_joint_twin/model/joint_state.hpp"
#include "harmonic_joint_twin/solver/dry_friction.hpp"
#include "harmonic_joint_twin/solver/ring_equilibrium.hpp"

namespace hjt
{
/// Right-hand side of the joint: the four-state rigid body with the ring in equilibrium at every instant.
///
/// Callable as `system(x, dxdt, t)` for Boost.odeint's explicit steppers; the leapfrog uses the parts.
class JointDynamics
{
public:
  JointDynamics(const JointModel& model, const SolverParameters& parameters);

  /// Inserts the wave generator and lets the output settle under its load, the motor held at angle 0.
  SolveStatus settle() noexcept;

  /// Ring in equilibrium at these angles. On failure the last good ring stays.
  SolveStatus place(double motor_angle, double output_angle) noexcept;

  /// All torques but friction at the present ring [N.m].
  Eigen::Vector2d torque() const noexcept { return model_.torque(ring_.forces(), ring_.position(), inputs); }

  /// Brings `friction()` up to date with the present ring; `speeds` of motor and output [rad/s].
  void updateFriction(const Eigen::Vector2d& speeds) noexcept;

  void operator()(const JointState& x, JointState& rate, double t) noexcept;

  const JointModel& model() const noexcept { return model_; }
  const RingEquilibrium& ring() const noexcept { return ring_; }
  const JointFriction& friction() const noexcept { return friction_; }
  const DryFriction& dryFriction() const noexcept { return dry_; }
  /// Output speed over motor speed at constant load: from the ring's stiffness, not from the tooth numbers [-].
  double follow() const noexcept;
  double storedEnergy() const noexcept { return model_.storedEnergy(ring_.forces(), ring_.position()); }

  JointInputs inputs;
  SolveStatus status;  ///< worst since it was last cleared by its reader

private:
  const JointModel& model_;
  RingEquilibrium ring_;
  DryFriction dry_;
  JointFriction friction_;
  Eigen::VectorXd running_;  // scratch
};
}  // namespace hjt
