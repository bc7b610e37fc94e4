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
/// `system` is a JointDynamics. If the ring does not converge the angles stay, the speeds become zero and
/// `system.status` says so.
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

  /// `goAhead` turns speeds at the instant of the angles into those half a step ahead: half of a kick, with half of its
  /// work, at the present ring. `comeBack` undoes it after the last step.
  void goAhead(JointDynamics& system, JointState& x, double dt) noexcept;
  void comeBack(JointState& x) const noexcept;

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

  /// Before a first step, at rest under a load [N.m]: nothing is delivered.
  void reset(double load_torque) noexcept
  {
    speeds_.setZero();
    work_.setZero();
    delivered_ = 0.0;
    link_torque_ = load_torque;
  }

private:
  Eigen::Vector2d speeds_{ 0.0, 0.0 };
  Eigen::Vector2d friction_{ 0.0, 0.0 };
  double balance_{};
  double delivered_{};
  double link_torque_{};
  Eigen::Vector3d work_{ 0.0, 0.0, 0.0 };  // of the last kick, in the order of the state [J]
};
}  // namespace hjt
