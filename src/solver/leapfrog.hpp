// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/numeric/odeint/stepper/stepper_categories.hpp>

#include "solver/joint_dynamics.hpp"

namespace hjt
{
/// Staggered leapfrog with implicit friction; meets Boost.odeint's stepper concept.
///
/// Between two calls the speeds of the state belong half a step ahead of its angles (Moreau's time stepping):
///   angles += h speeds;  ring at the new angles;  speeds: kicked by the torques there, friction implicit
/// One ring solve a step, order 2, symplectic without friction; a joint that sticks keeps its angle to the last bit,
/// because the speeds that move it have already seen friction.
///
/// `system` is a JointDynamics; its inputs act from the instant on that a step begins at. Half of each kick belongs to
/// the step after it: where inputs jump, that half is done again with the new ones. The first step begins with speeds
/// at the instant of the angles. If the ring does not converge the angles stay, the joint stands, what it moved with is
/// dissipated, and `system.status` says so.
class Leapfrog
{
public:
  using state_type = JointState;
  using deriv_type = JointState;
  using value_type = double;
  using time_type = double;
  using order_type = unsigned short;
  using stepper_category = boost::numeric::odeint::stepper_tag;

  static order_type order() noexcept { return 2; }

  void do_step(JointDynamics& system, JointState& x, double t, double dt) noexcept;

  /// Does the half of the last kick that belongs after the instant again: ring, inputs or step are others from here on.
  void retake(JointDynamics& system, JointState& x, double dt) noexcept;

  /// Speeds at the instant of the angles, mean of before and after the kick [rad/s].
  const Eigen::Vector2d& speeds() const noexcept { return speeds_; }

  /// Friction torque of the last kick on motor and output [N.m].
  const Eigen::Vector2d& frictionTorque() const noexcept { return friction_; }

  /// Motor work - load work - dissipated - kinetic energy at the instant of the angles [J].
  double balance() const noexcept { return balance_; }

  /// Work on the load and kinetic energy of the output, at the instant of the angles [J].
  double deliveredEnergy() const noexcept { return delivered_; }

  /// Of the gear and all friction on what hangs on the output, at the instant of the angles [N.m].
  double linkTorque() const noexcept { return link_torque_; }

  /// Before a first step, at rest under the load of an arm [N.m]: nothing is delivered.
  void reset(double arm_torque) noexcept
  {
    *this = {};
    acted_.arm_torque = arm_torque;
    link_torque_ = arm_torque;
  }

private:
  KickedSpeeds kick(JointDynamics& system, JointState& x, const Eigen::Vector2d& before, const Eigen::Vector2d& rubbing,
                    double lag, double dt) noexcept;
  Eigen::Vector3d works(const JointDynamics& system, const Eigen::Vector2d& speeds, double dt) const noexcept;
  bool actOtherwise(const JointDynamics& system) const noexcept;
  void stop(const JointDynamics& system, JointState& x) noexcept;

  Eigen::Vector2d speeds_{ 0.0, 0.0 };
  Eigen::Vector2d halfway_{ 0.0, 0.0 };  // through the last kick, at the instant of the angles [rad/s]
  Eigen::Vector2d friction_{ 0.0, 0.0 };
  double balance_{};
  double delivered_{};
  double link_torque_{};
  Eigen::Vector3d rest_{ 0.0, 0.0, 0.0 };  // of the last kick's works, after the instant [J]
  Eigen::Vector2d inertia_{ 0.0, 0.0 };    // that it moved [kg.m^2]
  Eigen::Vector2d half_kick_{ 0.0, 0.0 };  // change of the speeds after the instant [rad/s]
  /// The ledger takes the kinetic energy at an instant from the product of the speeds half a step before and after it.
  /// Where a half is done again, that changes though no speed at the instant does: by motor and output, summed [J].
  Eigen::Vector2d retaken_{ 0.0, 0.0 };
  JointInputs acted_;  // in the last kick
  bool moves_{};       // a kick was done: speeds are half a step ahead
};
}  // namespace hjt
