// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/numeric/odeint/stepper/stepper_categories.hpp>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "solver/joint_dynamics.hpp"

namespace hjt
{
/// Staggered leapfrog with implicit friction. It fulfils Boost.odeint's stepper concept.
///
/// Between two steps the speeds of the state are half a step ahead of its angles (Moreau's time stepping). A step of
/// length h first adds h times the speeds to the angles. The ring is then solved at the new angles. The kick, the
/// second part of the step, changes the speeds by the torques at these angles, with implicit friction. A step needs one
/// solve of the ring. The method has order 2 and is symplectic without friction. The angle of a joint that sticks is
/// constant to the last bit, because its speeds already include friction.
///
/// `system` is a JointDynamics whose inputs act from the beginning of a step. The second half of each kick belongs to
/// the following step. If the inputs jump, this half is repeated with the new inputs. The first step begins with speeds
/// at the instant of the angles. If the ring does not converge, the angles stay, the joint is set to rest, its kinetic
/// energy counts as dissipated, and `system.status` has the reason.
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

  /// Repeats the second half of the last kick after a change of the ring, the inputs or the length of a step.
  void retake(JointDynamics& system, JointState& x, double dt) noexcept;

  /// Speeds of motor and output at the instant of the angles: means over the kick [rad/s].
  const Eigen::Vector2d& speeds() const noexcept { return speeds_; }

  /// Friction torque of the last kick on motor and output [N.m].
  const Eigen::Vector2d& frictionTorque() const noexcept { return friction_; }

  /// Work of the motor - work on the load - dissipated - kinetic energy, at the instant of the angles [J].
  double balance() const noexcept { return balance_; }

  /// Work on the load plus kinetic energy of the output, at the instant of the angles [J].
  double deliveredEnergy() const noexcept { return delivered_; }

  /// Torque that gear and friction exert on load and arm, at the instant of the angles [N.m].
  double linkTorque() const noexcept { return link_torque_; }

  /// Resets to the state before the first step: at rest under the torque of an arm [N.m].
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
  Eigen::Vector3d rest_{ 0.0, 0.0, 0.0 };  // works in the second half of the last kick [J]
  Eigen::Vector2d inertia_{ 0.0, 0.0 };    // inertia of motor and output in the last kick [kg.m^2]
  Eigen::Vector2d half_kick_{ 0.0, 0.0 };  // change of the speeds in the second half of the last kick [rad/s]
  /// The energy account computes the kinetic energy at an instant from the product of the speeds half a step before and
  /// half a step after the instant. A repeated half kick changes this product, although the speeds at the instant stay.
  /// `retaken_` is the sum of these changes, for motor and output [J].
  Eigen::Vector2d retaken_{ 0.0, 0.0 };
  JointInputs acted_;  // inputs of the last kick
  bool moves_{};       // whether the speeds are half a step ahead of the angles, because there was a kick
};

/// Integrates the joint by the leapfrog in equal steps and keeps its energy account.
class JointStepper
{
public:
  /// Largest phase of an oscillation in a substep [rad]. The phase of the leapfrog is then ahead of the exact phase by
  /// phase^2 / 24 = 0.04 %, so that the error after four oscillations is a hundredth of the amplitude.
  static constexpr double MAX_PHASE_ADVANCE = 0.1;
  /// MAX_PHASE_ADVANCE of a joint in an arm [rad]. The phase of the leapfrog is then ahead by 0.7 %, but only in modes
  /// of light links at some kHz, which nothing in the arm excites.
  static constexpr double MAX_PHASE_ADVANCE_IN_ARM = 0.4;
  static constexpr int MAX_SUBSTEPS = 31;
  /// Largest speed of an output that counts as at rest [rad/s]. If only the regularised friction of the flanks holds
  /// the output, it creeps with up to 8e-7 rad/s at the shipped stiction_velocity.
  static constexpr double REST_SPEED = 2e-6;
  static constexpr double REST_TIME = 0.1;  ///< time at rest after which `step` solves nothing [s]

  /// @throws ParameterError if the step is too long for the stiffest motion of the joint.
  JointStepper(const Parameters& parameters, const JointModel& model);
  JointStepper(const JointStepper&) = default;  ///< requires setModel afterwards
  JointStepper& operator=(const JointStepper&) = delete;

  void setModel(const JointModel& copied) noexcept  ///< see RingEquilibrium::setModel
  {
    dynamics_.setModel(copied);
  }

  /// Sets the joint to rest in its equilibrium under an arm's torque [N.m]. @returns false if there is no equilibrium.
  bool reset(double arm_torque = 0.0) noexcept;

  /// Advances one step under `inputs`, which act from the beginning of the step. The motor's speed limit reduces the
  /// wanted torque, and the current loop delays it. @returns false if the ring did not converge; the joint then rests.
  ///
  /// A step that is too long for the joint's fastest oscillation is divided into `substeps()` equal substeps.
  /// Parameters and an arm's inertia determine the number of substeps, so that live and offline runs are equal. The
  /// number is odd, so that a new torque of the arm acts from the middle of the step on, as in an undivided step.
  ///
  /// A joint at rest (motor stuck, output slower than REST_SPEED for REST_TIME) is not solved until an input changes.
  bool step(const JointInputs& inputs) noexcept;

  /// Solves the full ring after a fault changed the model between two steps. The energy account counts the change of
  /// the stored energy as released. @returns false if the ring did not converge; the old ring then stays.
  bool updateModel() noexcept;
  /// energy released by changes of the model since the reset [J]
  double releasedEnergy() const noexcept { return released_; }

  /// Sets the inertia of an output in an arm, from the next step on [kg.m^2].
  void setOutputInertia(double inertia) noexcept;

  /// See JointDynamics::useSurface.
  [[nodiscard]] bool useSurface(const ResponseSurface* surface) noexcept;

  double motorAngle() const noexcept { return x_[joint_state::MOTOR_ANGLE]; }    ///< angle of the motor [rad]
  double outputAngle() const noexcept { return x_[joint_state::OUTPUT_ANGLE]; }  ///< angle of the output [rad]
  const Eigen::Vector2d& speeds() const noexcept { return speeds_; }             ///< speeds of motor and output [rad/s]
  const Eigen::Vector2d& frictionTorque() const noexcept { return friction_; }   ///< see Leapfrog::frictionTorque
  /// torque of the motor's current at 25 degC [N.m]
  double driveTorque() const noexcept { return x_[joint_state::DRIVE_TORQUE]; }
  /// Whether the speed limit reduces the motor's torque.
  bool isSpeedLimited() const noexcept
  {
    return dynamics_.model().motor.fades(dynamics_.inputs.motor_torque, speeds_[0]);
  }
  double energyResidual() const noexcept;  ///< energy since the reset: supplied - stored - dissipated - released [J]
  /// energy that all friction has dissipated [J]
  double dissipatedEnergy() const noexcept { return x_[joint_state::DISSIPATED]; }
  double energyThroughput() const noexcept { return throughput_; }  ///< sum of |work| of motor, load and friction [J]
  int substeps() const noexcept { return substeps_; }               ///< substeps of a step, 1 ... MAX_SUBSTEPS
  /// Phase of the fastest oscillation of motor against output in a substep, at the ring's present stiffness [rad].
  double phaseAdvance() const noexcept;
  bool isCoarse() const noexcept;  ///< whether phaseAdvance() exceeds MAX_PHASE_ADVANCE (in an arm: ..._IN_ARM)
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

  int rest_steps_{};  // number of successive steps at rest
  int substeps_{ 1 };
  double step_;     // length of a step [s]
  double substep_;  // length of a substep [s]
  double phase_limit_{ MAX_PHASE_ADVANCE };
  double stiffest_{};      // stiffest slope of the cup, with its friction [N.m/rad]
  double motor_square_{};  // motor's part of the squared frequency of the fastest oscillation [rad^2/s^2]
  JointDynamics dynamics_;
  Leapfrog leapfrog_;
  JointState x_{ JointState::Zero() };
  Eigen::Vector2d speeds_{ 0.0, 0.0 };
  Eigen::Vector2d friction_{ 0.0, 0.0 };
  double balance_{};          // motor work - load work - dissipated energy - kinetic energy [J]
  double stored_at_start_{};  // stored energy at the reset [J]
  double released_{};         // energy released by changes of the model since the reset [J]
  double throughput_{};
};
}  // namespace hjt
