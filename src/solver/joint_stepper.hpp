// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/numeric/odeint/stepper/stepper_categories.hpp>

#include "harmonic_joint_twin/params/parameters.hpp"
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

/// Marches the joint by the leapfrog, in equal steps, and keeps its energy ledger.
class JointStepper
{
public:
  /// Largest phase of a swing per step. The leapfrog then runs ahead by phase^2 / 24 = 0.04 %: after four swings its
  /// error is a hundredth of the swing's height [rad].
  static constexpr double MAX_PHASE_ADVANCE = 0.1;
  /// Within an arm, whose light links swing at kilohertz that nothing of it excites: 0.7 % ahead [rad].
  static constexpr double MAX_PHASE_ADVANCE_IN_ARM = 0.4;
  static constexpr int MAX_SUBSTEPS = 31;
  /// Of the output, 0.4 seconds of arc a second. Held by the friction of its flanks alone, regularised at the shipped
  /// speed, it creeps with up to 8e-7 [rad/s].
  static constexpr double REST_SPEED = 2e-6;
  static constexpr double REST_TIME = 0.1;  ///< [s]

  /// @throws ParameterError if the step is too long for the stiffest motion of the joint.
  JointStepper(const Parameters& parameters, const JointModel& model);
  JointStepper(const JointStepper&) = default;  ///< to be followed by setModel
  JointStepper& operator=(const JointStepper&) = delete;

  void setModel(const JointModel& copied) noexcept  ///< see RingEquilibrium
  {
    dynamics_.setModel(copied);
  }

  /// Puts the joint at rest where it settles under an arm's load [N.m]. @returns false if it does not settle.
  bool reset(double arm_torque = 0.0) noexcept;

  /// One step under `inputs`, which act from its begin on; the drive's speed limit and current loop take from the
  /// torque wanted. False: the ring did not converge; the last good angles stay, at rest.
  ///
  /// A step that is too long for the joint's fastest swing is done in `substeps()` equal ones. Their number is
  /// fixed by the parameters and an arm's inertia, so that live equals offline, and odd: the arm's load then acts from
  /// half a step before its instant on, as in a step that is not divided.
  ///
  /// A joint at rest stays as it is until an input changes: its motor sticks, and for REST_TIME its output has moved
  /// slower than regularised friction creeps, or than counts. Then nothing is solved.
  bool step(const JointInputs& inputs) noexcept;

  /// After an edit of the model between two steps, the full ring in use: what its stored energy changes by is set free,
  /// or taken up, by the fault. False: the ring did not converge and is still the old one.
  bool updateModel() noexcept;
  double releasedEnergy() const noexcept { return released_; }  ///< by edits of the model since reset [J]

  /// Within an arm: inertia of the output from the next step on [kg.m^2].
  void setOutputInertia(double inertia) noexcept;

  /// See JointDynamics.
  [[nodiscard]] bool useSurface(const ResponseSurface* surface) noexcept;

  double motorAngle() const noexcept { return x_[joint_state::MOTOR_ANGLE]; }    ///< [rad]
  double outputAngle() const noexcept { return x_[joint_state::OUTPUT_ANGLE]; }  ///< [rad]
  const Eigen::Vector2d& speeds() const noexcept { return speeds_; }             ///< motor, output [rad/s]
  const Eigen::Vector2d& frictionTorque() const noexcept { return friction_; }   ///< on motor and output [N.m]
  double driveTorque() const noexcept { return x_[joint_state::DRIVE_TORQUE]; }  ///< of the current, at 25 degC [N.m]
  /// The drive holds torque back at its speed limit.
  bool isSpeedLimited() const noexcept
  {
    return dynamics_.model().motor.fades(dynamics_.inputs.motor_torque, speeds_[0]);
  }
  double energyResidual() const noexcept;  ///< energy in - stored - dissipated - released since reset [J]
  double dissipatedEnergy() const noexcept { return x_[joint_state::DISSIPATED]; }  ///< by all friction [J]
  double energyThroughput() const noexcept { return throughput_; }  ///< sum of |work| of motor, load, friction [J]
  int substeps() const noexcept { return substeps_; }               ///< 1 ... MAX_SUBSTEPS
  /// Of the joint's fastest swing in one substep, motor against output on the ring's present stiffness [rad].
  double phaseAdvance() const noexcept;
  bool isCoarse() const noexcept;  ///< the phase advance is beyond MAX_PHASE_ADVANCE
  /// To what hangs on the output, since reset: work on load and arm, and the output's kinetic energy [J].
  double deliveredEnergy() const noexcept { return leapfrog_.deliveredEnergy(); }
  double linkTorque() const noexcept { return leapfrog_.linkTorque(); }    ///< see Leapfrog
  const SolveStatus& status() const noexcept { return dynamics_.status; }  ///< of the last step
  const JointDynamics& dynamics() const noexcept { return dynamics_; }

private:
  Eigen::Vector2d swingSquares() const noexcept;
  bool substep() noexcept;
  bool staysAtRest(const JointInputs& inputs) const noexcept;
  void prepareDivision(const Parameters& parameters) noexcept;
  double frequency(double output_inertia) const noexcept;
  int substepsFor(double phase) const noexcept;
  void divideAgain(double output_inertia) noexcept;

  int rest_steps_{};  // in a row at whose end the joint was at rest
  int substeps_{ 1 };
  double step_;     // [s]
  double substep_;  // [s]
  double phase_limit_{ MAX_PHASE_ADVANCE };
  double stiffest_{};      // slope of the cup, with its friction's [N.m/rad]
  double motor_square_{};  // of the motor's part in the fastest swing [rad^2/s^2]
  JointDynamics dynamics_;
  Leapfrog leapfrog_;
  JointState x_{ JointState::Zero() };
  Eigen::Vector2d speeds_{ 0.0, 0.0 };
  Eigen::Vector2d friction_{ 0.0, 0.0 };
  double balance_{};          // motor work - load work - dissipated - kinetic energy [J]
  double stored_at_start_{};  // [J]
  double released_{};         // [J]
  double throughput_{};
};
}  // namespace hjt
