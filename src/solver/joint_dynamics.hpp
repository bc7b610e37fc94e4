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
/// State of the joint and its energy ledger; a plain vector, so that Boost.odeint can march it.
using JointState = Eigen::Matrix<double, 8, 1>;

namespace joint_state
{
constexpr int MOTOR_ANGLE = 0;   ///< [rad]
constexpr int OUTPUT_ANGLE = 1;  ///< [rad]
constexpr int MOTOR_SPEED = 2;   ///< [rad/s]
constexpr int OUTPUT_SPEED = 3;  ///< [rad/s]
constexpr int MOTOR_WORK = 4;    ///< done by the motor's torque [J]
constexpr int LOAD_WORK = 5;     ///< done on the external load torque [J]
constexpr int DISSIPATED = 6;    ///< by all friction [J]
constexpr int DRIVE_TORQUE = 7;  ///< of the motor's current at 25 degC [N.m]
}  // namespace joint_state

/// Right-hand side of the joint: the four-state rigid body with the ring in equilibrium at every instant.
///
/// The equilibrium comes from Newton's method on the full ring; or, once a response surface is given, from that, as
/// long as the angles lie on it. It changes to the surface only where ring and surface agree.
///
/// Callable as `system(x, dxdt, t)` for Boost.odeint's explicit steppers; the leapfrog uses the parts.
class JointDynamics
{
public:
  JointDynamics(const JointModel& model, const SolverParameters& parameters);

  /// Inserts the wave generator and lets the output settle under its load, the motor held at angle 0.
  SolveStatus solveAtRest() noexcept;

  /// Uses this surface where it holds, else the full ring; null: the full ring alone. The surface must outlive its use.
  /// False: the full ring found no equilibrium at the angles that the joint had on the surface until now, and is
  /// elsewhere; angles and torques stay.
  [[nodiscard]] bool useSurface(const ResponseSurface* surface) noexcept;

  /// After an edit of the model: solves the full ring at the present angles.
  SolveStatus updateModel() noexcept;

  /// The present equilibrium is the surface's.
  bool onSurface() const noexcept { return on_surface_; }
  const ResponseSurface* surface() const noexcept { return surface_; }            ///< the one to be used; null: none
  const ResponseSurface::Place& surfacePlace() const noexcept { return place_; }  ///< while there

  /// Of the present equilibrium. While the surface is in use the full ring is elsewhere.
  DrivePosition position() const noexcept { return { motor_angle_, output_angle_, model_->ring.gear.wave_amplitude }; }

  /// Ring in equilibrium at these angles. On failure the last good ring stays.
  SolveStatus place(double motor_angle, double output_angle) noexcept;

  /// The same by the surface, where it is in use or agrees with the ring. False, and nothing done, elsewhere.
  bool placeOnSurface(double motor_angle, double output_angle) noexcept;

  /// The friction that remembers has come to the present ring for good. @returns what the cup's dissipated on the way
  /// [J].
  double accept() noexcept;

  /// All torques at the present ring but those of dry and viscous friction [N.m].
  Eigen::Vector2d torque() const noexcept
  {
    return model_->torque(response_, position(), shaftTorque(), inputs.load()) - now_.cup.torque * cup_rates_;
  }

  /// Of the drive, at the temperature of its magnets, without ripple [N.m].
  double shaftTorque() const noexcept { return drive_torque * model_->motor.torqueFactor(inputs.temperature); }

  /// Torque that the drive does work with at the present angle of the motor [N.m], and its ratio to the current's
  /// torque [-].
  double driveTorque() const noexcept { return model_->motor.rippled(shaftTorque(), motor_angle_); }
  double driveGain() const noexcept
  {
    return model_->motor.rippled(model_->motor.torqueFactor(inputs.temperature), motor_angle_);
  }

  /// Of friction at the motor shaft that builds up over its presliding angle, at the present ring [N.m].
  double preslidingTorque() const noexcept { return -now_.share * friction_.presliding; }

  /// Stiffness of the joint by friction with a memory (presliding), at the present ring [N.m/rad].
  Eigen::Matrix2d frictionStiffness() const noexcept
  {
    Eigen::Matrix2d stiffness = now_.cup.stiffness * cup_rates_ * cup_rates_.transpose();
    if (friction_.presliding > 0.0)
    {
      stiffness(0, 0) += friction_.presliding * (1.0 + std::abs(now_.share)) / model_->motor.preslidingAngle();
    }
    return stiffness;
  }

  /// Brings `friction()` up to date with the present ring; `speeds` of motor and output [rad/s].
  void updateFriction(const Eigen::Vector2d& speeds) noexcept;

  /// DryFriction::stopOrSlide by the present friction; where that is not solved the joint stands, and `status` says so.
  KickedSpeeds stopOrSlide(const DryFriction& friction, const Eigen::Vector2d& before, const Eigen::Vector2d& momentum,
                           double dt) noexcept;

  void operator()(const JointState& x, JointState& rate, double t) noexcept;

  const JointModel& model() const noexcept { return *model_; }
  void setModel(const JointModel& copied) noexcept  ///< see RingEquilibrium
  {
    model_ = &copied;
    ring_.setModel(copied.ring);
  }
  /// Of motor and output: the model's, or with that of an arm around the joint [kg.m^2].
  const Eigen::Vector2d& inertia() const noexcept { return inertia_; }
  void setOutputInertia(double inertia) noexcept
  {
    inertia_[1] = inertia;
    dry_.setOutput(inertia);
  }
  const RingEquilibrium& ring() const noexcept { return ring_; }
  double outputAngle() const noexcept { return output_angle_; }  ///< of the present equilibrium [rad]
  const RingResponse& response() const noexcept { return response_; }
  const JointFriction& friction() const noexcept { return friction_; }
  const DryFriction& dryFriction() const noexcept { return dry_; }
  /// Output speed over motor speed at constant load: from the ring's stiffness, not from the tooth numbers [-].
  double velocityRatio() const noexcept { return response_.velocity_ratio; }
  double storedEnergy() const noexcept { return model_->storedEnergy(response_, position()) + now_.cup.energy; }

  JointInputs inputs;
  double drive_torque{};  ///< of the motor's current at 25 degC: what limit and lag leave of that wanted [N.m]
  SolveStatus status;     ///< worst since it was last cleared by its reader

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

  /// Internal state of the friction after the motion to some angles.
  struct Memory
  {
    CupFriction::State cup;
    double share{};        // of the friction at the motor shaft that is mobilised, -1 ... 1
    double motor_angle{};  // [rad]
    Brake::Pin pin;
  };

  const JointModel* model_;
  Eigen::Vector2d inertia_;
  RingEquilibrium ring_;
  RingResponse response_;  // present
  double motor_angle_{};   // of it [rad]
  double output_angle_{};
  const ResponseSurface* surface_{};
  ResponseSurface::Place place_{};
  Eigen::Vector2d housing_stiffness_{ 0.0, 0.0 };  // on the surface, by motor and output [N.m/rad]
  bool on_surface_{};
  bool surface_agrees_{};  // at the present angles, while on the full ring
  DryFriction dry_;
  JointFriction friction_;
  bool friction_is_of_ring_{};  // of the present equilibrium of the full ring, at some speeds
  JointFriction sticking_;      // room for the part of it that does not slide
  bool remembers_;              // friction does
  Memory accepted_;
  Memory now_;                             // at the present ring
  Eigen::Vector2d cup_rates_{ 0.0, 0.0 };  // of the rim's mean rotation by motor and output angle, if that matters
  double temperature_;                     // that the viscosity is known for [degC]
  double viscosity_;                       // [m^2/s]
};
}  // namespace hjt
