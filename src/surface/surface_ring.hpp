// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"
#include "solver/ring_equilibrium.hpp"

namespace hjt
{
/// The parameters that a response surface needs besides its model.
struct SurfaceParameters
{
  SurfaceParameters(const Parameters& of);

  GearParameters gear;
  MeshParameters mesh;
  MeshParameters unit_friction;  ///< mesh with coefficients of friction 1
  CupParameters cup;
  MotorParameters motor;
  OutputParameters output;
  InputParameters input;
  double momentary_peak_torque;  ///< [N.m]
};

/// Largest number of points of a table of the ring: 85 MB. The shipped gear needs a tenth of it.
constexpr std::size_t MAX_SURFACE_POINTS = 500000;

/// Reason why there is no table of more than `most` points, with the parameters that determine its size.
std::string tooManyPoints(const SurfaceParameters& parameters, std::size_t most);

/// A ring in equilibrium that moves over the nodes of a response surface and is measured there.
class SurfaceRing
{
public:
  SurfaceRing(const SurfaceParameters& parameters, JointModel model);

  SurfaceRing(const SurfaceRing&) = delete;  // the ring refers to the model
  SurfaceRing& operator=(const SurfaceRing&) = delete;

  /// Solves at angle 0 of motor and output without a guess. @returns false if it did not converge.
  bool insert();

  /// Moves to v = output angle - motor angle / ratio [rad]. @returns false without an equilibrium.
  bool moveTo(double motor_angle, double v);

  /// Moves with initial tooth points as a guess.
  bool moveTo(double motor_angle, double v, const Eigen::VectorXd& guess);

  /// Tooth points [m] and, after `measure`, their derivatives by the motor's angle at constant v [m/rad].
  const Eigen::VectorXd& points() const noexcept { return ring_.shape().points; }
  Eigen::VectorXd rates() const { return ring_.byWaveGenerator() + ring_.byOutput() / ratio_; }

  /// All values of a node at the present position.
  SurfaceNode measure();

  /// Values of a node of the ToothResponse; `values` has room for all quantities of the solved teeth.
  void measureTeeth(float* values) const noexcept;
  int teeth() const noexcept { return ring_.shape().teeth(); }
  int solvedTeeth() const noexcept
  {
    return ring_.shape().solved;
  }  ///< half of the teeth if the other half is equal; valid after insertion

  double motorAngle() const noexcept { return ring_.position().wave_generator_angle; }  ///< [rad]
  double pitch() const noexcept { return pitch_; }                                      ///< of the teeth [rad]
  double ratio() const noexcept { return ratio_; }                                      ///< nominal [-]
  /// Torque limit of load or motor at the output [N.m], at most COLLISION_MARGIN times the momentary peak torque for
  /// the motor.
  double torqueLimit() const noexcept { return torque_limit_; }
  const JointModel& model() const noexcept { return model_; }
  JointModel& editModel() noexcept { return model_; }  ///< call between two moves
  /// Forces of the wave generator on the teeth at the present position, N [N].
  const Eigen::VectorXd& contactForce() const noexcept { return ring_.forces().of<WaveGeneratorContact>().force; }

  /// Change of v from no load under this torque at the softest slope of the cup [rad].
  double twist(double torque) const noexcept { return torque / softest_; }

  /// Tolerance of a table's output torque at a node [N.m]: the torque of 0.002 seconds of arc.
  double outputTolerance(const SurfaceNode& node) const noexcept;

  /// Tolerance of the motor's torque [N.m]: a share of the motor's torque limit or, without one, of the load's limit
  /// reduced to the motor.
  double motorTolerance(const SurfaceNode& node) const noexcept;

  /// Tolerance of the friction at the motor [N.m]: that of the motor's torque. On balls it is at least 1 % of the
  /// friction, because a tooth that begins to touch changes the rates of all balls by some per cent, which no grid
  /// resolves.
  double frictionTolerance(const SurfaceNode& node) const noexcept;

  /// Friction of ring and bearing at the motor for slow running, with static flank friction [N.m].
  double frictionTorque(const SurfaceNode& node) const noexcept;

  /// Friction of the flanks per unit of their coefficient [N.m].
  static double flankFriction(const SurfaceNode& node) noexcept;

  /// Number of teeth after which the gear repeats at constant v: 1 with equal teeth, half a turn or a turn if those of
  /// one part differ; 0: none of these. Torques of both signs, sampled once a pitch, decide.
  int repetition();

  /// Whether the gear has mirror symmetry: equal friction and opposite torques at opposite angles. Positions at three
  /// loads decide. False also without an equilibrium.
  bool isMirrored();

  int solves() const noexcept { return solves_; }

  /// Factor on the tolerances beyond the torque limits.
  double overload(const SurfaceNode& node) const noexcept;

private:
  JointModel model_;
  MeshFriction unit_friction_;
  RingEquilibrium ring_;
  JointFriction friction_;
  Eigen::VectorXd tooth_angles_;
  double pitch_;
  double ratio_;
  double wave_amplitude_;
  double torque_limit_;
  double motor_limit_;  // [N.m]
  double softest_;      // softest slope of the cup [N.m/rad]
  double static_friction_;
  double temperature_;
  int solves_{};
};
}  // namespace hjt
