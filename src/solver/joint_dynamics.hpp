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
/// State of the joint and its energy account. Boost.odeint can integrate this plain vector.
using JointState = Eigen::Matrix<double, 8, 1>;

namespace joint_state
{
constexpr int MOTOR_ANGLE = 0;   ///< [rad]
constexpr int OUTPUT_ANGLE = 1;  ///< [rad]
constexpr int MOTOR_SPEED = 2;   ///< [rad/s]
constexpr int OUTPUT_SPEED = 3;  ///< [rad/s]
constexpr int MOTOR_WORK = 4;    ///< work of the motor's torque [J]
constexpr int LOAD_WORK = 5;     ///< work on the external load torque [J]
constexpr int DISSIPATED = 6;    ///< energy that all friction has dissipated [J]
constexpr int DRIVE_TORQUE = 7;  ///< torque of the motor's current at 25 degC [N.m]
}  // namespace joint_state

/// Right-hand side of the joint's equation of motion: a rigid body with four states and a ring that is always in
/// equilibrium.
///
/// The equilibrium is that of the full ring by Newton's method or, if there is a response surface, that of the surface
/// where it contains the angles. The change to the surface requires that ring and surface agree.
///
/// Boost.odeint's explicit steppers call `system(x, dxdt, t)`; the leapfrog uses the parts.
class JointDynamics
{
public:
  JointDynamics(const JointModel& model, const SolverParameters& parameters);

  /// Inserts the wave generator and balances the output's load with the motor at angle 0.
  SolveStatus solveAtRest() noexcept;

  /// Uses this surface where it is valid, else the full ring; null: the full ring alone. The surface must outlive its
  /// use.
  /// @returns false if the full ring has no equilibrium at the present angles on the surface. Angles and torques then
  /// stay,
  /// although the full ring is elsewhere.
  [[nodiscard]] bool useSurface(const ResponseSurface* surface) noexcept;

  /// Solves the full ring at the present angles after a change of the model.
  SolveStatus updateModel() noexcept;

  /// Whether the present equilibrium is that of the surface.
  bool onSurface() const noexcept { return on_surface_; }
  const ResponseSurface* surface() const noexcept { return surface_; }            ///< surface in use; null: none
  const ResponseSurface::Place& surfacePlace() const noexcept { return place_; }  ///< valid on the surface

  /// Present position. While the surface is in use, the full ring may be elsewhere.
  DrivePosition position() const noexcept { return { motor_angle_, output_angle_, model_->ring.gear.wave_amplitude }; }

  /// Solves the equilibrium at these angles. On failure the last converged ring stays.
  SolveStatus place(double motor_angle, double output_angle) noexcept;

  /// Takes the equilibrium from the surface if it is in use or agrees with the ring. @returns false and does nothing
  /// otherwise.
  bool placeOnSurface(double motor_angle, double output_angle) noexcept;

  /// Commits the internal state of the friction at the present ring. @returns the energy that the cup's friction
  /// dissipated [J].
  double accept() noexcept;

  /// Torques at the present ring, without dry and viscous friction [N.m].
  Eigen::Vector2d torque() const noexcept
  {
    return model_->torque(response_, position(), shaftTorque(), inputs.load()) - now_.cup.torque * cup_rates_;
  }

  /// Torque of the drive at the temperature of its magnets, without ripple [N.m].
  double shaftTorque() const noexcept { return drive_torque * model_->motor.torqueFactor(inputs.temperature); }

  /// Torque of the drive at the present motor angle [N.m], and its ratio to the torque of the current [-].
  double driveTorque() const noexcept { return model_->motor.rippled(shaftTorque(), motor_angle_); }
  double driveGain() const noexcept
  {
    return model_->motor.rippled(model_->motor.torqueFactor(inputs.temperature), motor_angle_);
  }

  /// Friction at the motor shaft that builds up over its presliding angle, at the present ring [N.m].
  double preslidingTorque() const noexcept { return -now_.share * friction_.presliding; }

  /// Stiffness of the joint by friction with a state, at the present ring [N.m/rad].
  Eigen::Matrix2d frictionStiffness() const noexcept
  {
    Eigen::Matrix2d stiffness = now_.cup.stiffness * cup_rates_ * cup_rates_.transpose();
    if (friction_.presliding > 0.0)
    {
      stiffness(0, 0) += friction_.presliding * (1.0 + std::abs(now_.share)) / model_->motor.preslidingAngle();
    }
    return stiffness;
  }

  /// Computes `friction()` for the present ring; `speeds`: of motor and output [rad/s].
  void updateFriction(const Eigen::Vector2d& speeds) noexcept;

  /// Solves DryFriction::stopOrSlide with the present friction. On failure the joint is set to rest and `status` says
  /// so.
  KickedSpeeds stopOrSlide(const DryFriction& friction, const Eigen::Vector2d& before, const Eigen::Vector2d& momentum,
                           double dt) noexcept;

  void operator()(const JointState& x, JointState& rate, double t) noexcept;

  const JointModel& model() const noexcept { return *model_; }
  void setModel(const JointModel& copied) noexcept  ///< see RingEquilibrium::setModel
  {
    model_ = &copied;
    ring_.setModel(copied.ring);
  }
  /// Inertia of motor and output, with that of an arm if it is coupled [kg.m^2].
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
  /// Output speed over motor speed at constant load, from the stiffness of the ring [-].
  double velocityRatio() const noexcept { return response_.velocity_ratio; }
  double storedEnergy() const noexcept { return model_->storedEnergy(response_, position()) + now_.cup.energy; }

  JointInputs inputs;
  double drive_torque{};  ///< torque of the motor's current at 25 degC, after limit and lag [N.m]
  SolveStatus status;     ///< worst status since the reader last cleared it

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

  /// Internal state of the friction after a motion to some angles.
  struct Memory
  {
    CupFriction::State cup;
    double share{};        // mobilised share of the friction at the motor shaft, -1 ... 1
    double motor_angle{};  // [rad]
    Brake::Pin pin;
  };

  const JointModel* model_;
  Eigen::Vector2d inertia_;
  RingEquilibrium ring_;
  RingResponse response_;  // at the present angles
  double motor_angle_{};   // of the present equilibrium [rad]
  double output_angle_{};
  const ResponseSurface* surface_{};
  ResponseSurface::Place place_{};
  Eigen::Vector2d housing_stiffness_{ 0.0, 0.0 };  // on the surface, by motor and output angle [N.m/rad]
  bool on_surface_{};
  bool surface_agrees_{};  // at the present angles of the full ring
  DryFriction dry_;
  JointFriction friction_;
  bool friction_is_of_ring_{};  // whether friction_ belongs to the present equilibrium of the full ring
  JointFriction sticking_;      // working memory: friction of the terms that stick
  bool remembers_;              // whether the friction has a state
  Memory accepted_;
  Memory now_;  // at the present ring
  // derivatives of the rim's mean rotation by motor and output angle, if needed
  Eigen::Vector2d cup_rates_{ 0.0, 0.0 };
  double temperature_;  // for which viscosity_ is valid [degC]
  double viscosity_;    // [m^2/s]
};
}  // namespace hjt
