// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "model/joint_model.hpp"
#include "solver/dry_friction.hpp"
#include "solver/response_surface.hpp"
#include "solver/ring_equilibrium.hpp"

namespace hjt
{
/// State of the joint and its energy account, as a plain vector that Boost.odeint can integrate.
using JointState = Eigen::Matrix<double, 8, 1>;

namespace joint_state
{
constexpr int MOTOR_ANGLE = 0;   ///< index of the motor's angle [rad]
constexpr int OUTPUT_ANGLE = 1;  ///< index of the output's angle [rad]
constexpr int MOTOR_SPEED = 2;   ///< index of the motor's speed [rad/s]
constexpr int OUTPUT_SPEED = 3;  ///< index of the output's speed [rad/s]
constexpr int MOTOR_WORK = 4;    ///< index of the work of the motor's torque [J]
constexpr int LOAD_WORK = 5;     ///< index of the work done on the external load [J]
constexpr int DISSIPATED = 6;    ///< index of the energy that all friction has dissipated [J]
constexpr int DRIVE_TORQUE = 7;  ///< index of the torque of the motor's current at 25 degC [N.m]
}  // namespace joint_state

/// Right-hand side of the joint's equation of motion. Motor and output are rigid, and the ring between them is always
/// in equilibrium.
///
/// If there is a response surface and its range contains the angles, the equilibrium comes from the surface. Otherwise
/// Newton's method solves the full ring. The change from ring to surface requires that their torques agree.
///
/// Boost.odeint's explicit steppers call `system(x, dxdt, t)`. Leapfrog calls the other functions of this class
/// instead.
class JointDynamics
{
public:
  JointDynamics(const JointModel& model, const SolverParameters& parameters);

  /// Inserts the wave generator and balances the output's load with the motor at angle 0.
  SolveStatus solveAtRest() noexcept;

  /// Uses `surface` for angles in its range, and the full ring for other angles. `surface`: null for the full ring
  /// alone; must outlive its use. @returns false if the full ring has no equilibrium at the present angles on the
  /// surface. The joint then keeps its angles and torques, although the full ring is at other angles.
  [[nodiscard]] bool useSurface(const ResponseSurface* surface) noexcept;

  /// Solves the full ring at the present angles. Must be called after a change of the model.
  SolveStatus updateModel() noexcept;

  /// Whether the present equilibrium is that of the surface.
  bool onSurface() const noexcept { return on_surface_; }
  const ResponseSurface* surface() const noexcept { return surface_; }            ///< surface in use; null: none
  const ResponseSurface::Place& surfacePlace() const noexcept { return place_; }  ///< place; valid if onSurface()

  /// Present angles of the joint. While the joint is on the surface, the full ring may be at other angles.
  DrivePosition position() const noexcept { return { motor_angle_, output_angle_, model_->ring.gear.wave_amplitude }; }

  /// Solves the equilibrium at two angles [rad], from the surface or the full ring. On failure the last ring stays.
  SolveStatus place(double motor_angle, double output_angle) noexcept;

  /// Takes the equilibrium from the surface if the joint is on the surface, or if the torques of surface and ring
  /// agree. @returns false and does nothing otherwise.
  bool placeOnSurface(double motor_angle, double output_angle) noexcept;

  /// Makes the internal state of the friction at the present angles the start of the next motion. @returns the energy
  /// that the cup's friction dissipated since the last call [J].
  double accept() noexcept;

  /// Torques on motor and output at the present angles, without dry and viscous friction [N.m].
  Eigen::Vector2d torque() const noexcept
  {
    return model_->torque(response_, position(), shaftTorque(), inputs.load()) - now_.cup.torque * cup_rates_;
  }

  /// Torque of the motor without ripple, with the magnets at the temperature of the grease [N.m].
  double shaftTorque() const noexcept { return drive_torque * model_->motor.torqueFactor(inputs.temperature); }

  /// Torque of the motor with ripple at the present angle [N.m]. driveGain: this torque per torque of the current [-].
  double driveTorque() const noexcept { return model_->motor.rippled(shaftTorque(), motor_angle_); }
  double driveGain() const noexcept
  {
    return model_->motor.rippled(model_->motor.torqueFactor(inputs.temperature), motor_angle_);
  }

  /// Torque of the friction at the motor shaft that builds up over the presliding angle, at the present angles [N.m].
  double preslidingTorque() const noexcept { return -now_.share * friction_.presliding; }

  /// Stiffness by friction with a state (cup and presliding) by motor and output angle, at the present angles
  /// [N.m/rad].
  Eigen::Matrix2d frictionStiffness() const noexcept
  {
    Eigen::Matrix2d stiffness = now_.cup.stiffness * cup_rates_ * cup_rates_.transpose();
    if (friction_.presliding > 0.0)
    {
      stiffness(0, 0) += friction_.presliding * (1.0 + std::abs(now_.share)) / model_->motor.preslidingAngle();
    }
    return stiffness;
  }

  /// Computes `friction()` for the present angles. `speeds`: speeds of motor and output [rad/s].
  void updateFriction(const Eigen::Vector2d& speeds) noexcept;

  /// Calls DryFriction::stopOrSlide with the present friction. On failure the speeds are 0.
  KickedSpeeds stopOrSlide(const DryFriction& friction, const Eigen::Vector2d& before, const Eigen::Vector2d& momentum,
                           double dt) noexcept;

  void operator()(const JointState& x, JointState& rate, double t) noexcept;

  const JointModel& model() const noexcept { return *model_; }
  void setModel(const JointModel& copied) noexcept  ///< see RingEquilibrium::setModel
  {
    model_ = &copied;
    ring_.setModel(copied.ring);
  }
  /// Inertia of motor and output. If the joint is in an arm, the output's inertia includes the arm's [kg.m^2].
  const Eigen::Vector2d& inertia() const noexcept { return inertia_; }
  void setOutputInertia(double inertia) noexcept
  {
    inertia_[1] = inertia;
    dry_.setOutput(inertia);
  }
  const RingEquilibrium& ring() const noexcept { return ring_; }
  double outputAngle() const noexcept { return output_angle_; }  ///< angle of the present equilibrium [rad]
  const RingResponse& response() const noexcept { return response_; }
  const JointFriction& friction() const noexcept { return friction_; }
  const DryFriction& dryFriction() const noexcept { return dry_; }
  /// Output speed over motor speed at constant load, which follows from the stiffness of the ring [-].
  double velocityRatio() const noexcept { return response_.velocity_ratio; }
  double storedEnergy() const noexcept { return model_->storedEnergy(response_, position()) + now_.cup.energy; }

  JointInputs inputs;
  double drive_torque{};  ///< torque of the motor's current at 25 degC, after torque limit and lag [N.m]
  SolveStatus status;     ///< reason of the last failed solve and effort of all solves since the caller cleared it

private:
  bool bringRing() noexcept;
  void note(const SolveStatus& solved) noexcept;
  SolveStatus placeRing(double motor_angle, double output_angle) noexcept;
  void takeRing() noexcept;
  void takeSurface() noexcept;
  void turnCup(double rotation, const Eigen::Vector2d& rates) noexcept;
  void slideShaft() noexcept;
  bool surfaceAgrees() const noexcept;
  double viscosity() noexcept;
  double brakeTorque(double motor_speed) noexcept;

  /// Internal state of the friction after a motion.
  struct Memory
  {
    CupFriction::State cup;
    double share{};        // share of its full torque that the friction at the motor shaft has, -1 ... 1
    double motor_angle{};  // motor angle after the motion [rad]
    Brake::Pin pin;
  };

  const JointModel* model_;
  Eigen::Vector2d inertia_;
  RingEquilibrium ring_;
  RingResponse response_;  // energy, torques and stiffness at the present angles
  double motor_angle_{};   // motor angle of the present equilibrium [rad]
  double output_angle_{};
  const ResponseSurface* surface_{};
  ResponseSurface::Place place_{};
  Eigen::Vector2d housing_stiffness_{ 0.0, 0.0 };  // see ResponseSurface::response [N.m/rad]
  bool on_surface_{};
  bool surface_agrees_{};  // surfaceAgrees() at the present angles
  DryFriction dry_;
  JointFriction friction_;
  bool friction_is_of_ring_{};  // whether friction_ belongs to the present equilibrium of the full ring
  JointFriction sticking_;      // working memory: friction of the terms that stick
  bool remembers_;              // whether the friction has a state
  Memory accepted_;
  Memory now_;  // state of the friction at the present angles
  // derivatives of the rim's mean rotation by motor and output angle, if the cup's friction has a state [-]
  Eigen::Vector2d cup_rates_{ 0.0, 0.0 };
  double temperature_;  // temperature for which viscosity_ is valid [degC]
  double viscosity_;    // effective viscosity of the bearing's grease [m^2/s]
};
}  // namespace hjt
