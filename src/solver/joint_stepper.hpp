// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/numeric/odeint/stepper/stepper_categories.hpp>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "solver/joint_dynamics.hpp"

namespace hjt
{
/// Staggered leapfrog with implicit friction. It fulfils Boost.odeint's stepper concept.
///
/// Between two calls the speeds of the state are half a step ahead of its angles (Moreau's time stepping):
///   angles += h speeds;  ring at the new angles;  speeds: changed by the torques there, with implicit friction
/// A step needs one solve of the ring. The method has order 2 and is symplectic without friction. The angle of a joint
/// that sticks is constant to the last bit, because its speeds already include friction.
///
/// `system` is a JointDynamics whose inputs act from the beginning of a step. Half of each kick, the change of the
/// speeds, belongs to the following step; if the inputs jump, that half is repeated with the new inputs. The first step
/// begins with speeds at the instant of the angles. If the ring does not converge, the angles stay, the joint is set to
/// rest, its kinetic energy counts as dissipated, and `system.status` says so.
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

  /// Repeats the second half of the last kick after a change of ring, inputs or step.
  void retake(JointDynamics& system, JointState& x, double dt) noexcept;

  /// Speeds at the instant of the angles, means over the kick [rad/s].
  const Eigen::Vector2d& speeds() const noexcept { return speeds_; }

  /// Friction torque of the last kick on motor and output [N.m].
  const Eigen::Vector2d& frictionTorque() const noexcept { return friction_; }

  /// Motor work - load work - dissipated - kinetic energy at the instant of the angles [J].
  double balance() const noexcept { return balance_; }

  /// Work on the load and kinetic energy of the output, at the instant of the angles [J].
  double deliveredEnergy() const noexcept { return delivered_; }

  /// Torque of the gear and all friction on load and arm, at the instant of the angles [N.m].
  double linkTorque() const noexcept { return link_torque_; }

  /// Resets to rest under the load of an arm [N.m], before the first step; the delivered energy becomes zero.
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
  Eigen::Vector2d halfway_{ 0.0, 0.0 };  // speeds in the middle of the last kick, at the instant of the angles [rad/s]
  Eigen::Vector2d friction_{ 0.0, 0.0 };
  double balance_{};
  double delivered_{};
  double link_torque_{};
  Eigen::Vector3d rest_{ 0.0, 0.0, 0.0 };  // works of the last kick after the instant [J]
  Eigen::Vector2d inertia_{ 0.0, 0.0 };    // inertia in the last kick [kg.m^2]
  Eigen::Vector2d half_kick_{ 0.0, 0.0 };  // change of the speeds after the instant [rad/s]
  /// The energy account takes the kinetic energy at an instant from the product of the speeds half a step before and
  /// after it. A repeated half kick changes this product, although no speed at the instant changes: sum by motor and
  /// output [J].
  Eigen::Vector2d retaken_{ 0.0, 0.0 };
  JointInputs acted_;  // inputs of the last kick
  bool moves_{};       // speeds are half a step ahead because a kick was done
};

/// Integrates the joint by the leapfrog in equal steps and keeps its energy account.
class JointStepper
{
public:
  /// Largest phase of an oscillation in a step [rad]. The leapfrog then runs ahead by phase^2 / 24 = 0.04 %, so that
  /// the error after four oscillations is a hundredth of the amplitude.
  static constexpr double MAX_PHASE_ADVANCE = 0.1;
  /// Within an arm [rad]. Its light links have kilohertz modes that nothing in the arm excites; 0.7 % ahead.
  static constexpr double MAX_PHASE_ADVANCE_IN_ARM = 0.4;
  static constexpr int MAX_SUBSTEPS = 31;
  /// Speed of an output at rest, 0.4 seconds of arc a second [rad/s]. An output that only the regularised friction of
  /// its flanks holds creeps with up to 8e-7 rad/s at the shipped stiction_velocity.
  static constexpr double REST_SPEED = 2e-6;
  static constexpr double REST_TIME = 0.1;  ///< [s]

  /// @throws ParameterError if the step is too long for the stiffest motion of the joint.
  JointStepper(const Parameters& parameters, const JointModel& model);
  JointStepper(const JointStepper&) = default;  ///< requires setModel afterwards
  JointStepper& operator=(const JointStepper&) = delete;

  void setModel(const JointModel& copied) noexcept  ///< see RingEquilibrium::setModel
  {
    dynamics_.setModel(copied);
  }

  /// Puts the joint at rest where it settles under an arm's load [N.m]. @returns false if it does not settle.
  bool reset(double arm_torque = 0.0) noexcept;

  /// Advances one step under `inputs`, which act from its beginning. The drive's speed limit and current loop reduce
  /// the wanted torque. @returns false if the ring did not converge; the last angles then stay, at rest.
  ///
  /// A step that is too long for the joint's fastest oscillation is divided into `substeps()` equal ones. Parameters
  /// and an arm's inertia determine their number, so that live and offline runs are equal. The number is odd: the arm's
  /// load then acts from half a step before its instant on, as in an undivided step.
  ///
  /// A joint at rest is not solved until an input changes. It is at rest if its motor sticks and, for REST_TIME, its
  /// output has moved slower than REST_SPEED.
  bool step(const JointInputs& inputs) noexcept;

  /// Solves the full ring after a change of the model between two steps. The fault releases or absorbs the change of
  /// the stored energy. @returns false if the ring did not converge; the old ring then stays.
  bool updateModel() noexcept;
  /// energy released by changes of the model since the reset [J]
  double releasedEnergy() const noexcept { return released_; }

  /// Sets the output's inertia within an arm, from the next step on [kg.m^2].
  void setOutputInertia(double inertia) noexcept;

  /// See JointDynamics::useSurface.
  [[nodiscard]] bool useSurface(const ResponseSurface* surface) noexcept;

  double motorAngle() const noexcept { return x_[joint_state::MOTOR_ANGLE]; }    ///< [rad]
  double outputAngle() const noexcept { return x_[joint_state::OUTPUT_ANGLE]; }  ///< [rad]
  const Eigen::Vector2d& speeds() const noexcept { return speeds_; }             ///< speeds of motor and output [rad/s]
  const Eigen::Vector2d& frictionTorque() const noexcept { return friction_; }   ///< on motor and output [N.m]
  /// torque of the current at 25 degC [N.m]
  double driveTorque() const noexcept { return x_[joint_state::DRIVE_TORQUE]; }
  /// Whether the drive reduces its torque at the speed limit.
  bool isSpeedLimited() const noexcept
  {
    return dynamics_.model().motor.fades(dynamics_.inputs.motor_torque, speeds_[0]);
  }
  double energyResidual() const noexcept;  ///< energy since the reset: supplied - stored - dissipated - released [J]
  /// energy that all friction has dissipated [J]
  double dissipatedEnergy() const noexcept { return x_[joint_state::DISSIPATED]; }
  double energyThroughput() const noexcept { return throughput_; }  ///< sum of |work| of motor, load and friction [J]
  int substeps() const noexcept { return substeps_; }               ///< 1 ... MAX_SUBSTEPS
  /// Phase of the joint's fastest oscillation, motor against output, in a substep at the ring's present stiffness
  /// [rad].
  double phaseAdvance() const noexcept;
  bool isCoarse() const noexcept;  ///< whether the phase advance exceeds MAX_PHASE_ADVANCE
  /// Work on load and arm plus kinetic energy of the output since the reset [J].
  double deliveredEnergy() const noexcept { return leapfrog_.deliveredEnergy(); }
  double linkTorque() const noexcept { return leapfrog_.linkTorque(); }    ///< see Leapfrog::linkTorque
  const SolveStatus& status() const noexcept { return dynamics_.status; }  ///< status of the last step
  const JointDynamics& dynamics() const noexcept { return dynamics_; }

private:
  Eigen::Vector2d swingSquares() const noexcept;
  bool substep() noexcept;
  bool staysAtRest(const JointInputs& inputs) const noexcept;
  void prepareDivision(const Parameters& parameters) noexcept;
  double frequency(double output_inertia) const noexcept;
  int substepsFor(double phase) const noexcept;
  void divideAgain(double output_inertia) noexcept;

  int rest_steps_{};  // successive steps after which the joint was at rest
  int substeps_{ 1 };
  double step_;     // [s]
  double substep_;  // [s]
  double phase_limit_{ MAX_PHASE_ADVANCE };
  double stiffest_{};      // slope of the cup with its friction [N.m/rad]
  double motor_square_{};  // motor's part of the squared frequency of the fastest oscillation [rad^2/s^2]
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
