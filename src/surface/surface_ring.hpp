// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"
#include "solver/ring_equilibrium.hpp"

namespace hjt
{
/// Parameters that the build of a response surface needs in addition to the model.
struct SurfaceParameters
{
  SurfaceParameters(const Parameters& of);

  GearParameters gear;
  MeshParameters mesh;
  MeshParameters unit_friction;  ///< parameters of a mesh whose coefficients of friction are 1
  CupParameters cup;
  MotorParameters motor;
  OutputParameters output;
  InputParameters input;
  double momentary_peak_torque;  ///< momentary peak torque of the gear [N.m]
};

/// Largest number of points of a SurfaceTable: 85 MB. The shipped gear needs a tenth of these points.
constexpr std::size_t MAX_SURFACE_POINTS = 500000;

/// Reason why there is no table of more than `most` points, with the parameters that determine its size.
std::string tooManyPoints(const SurfaceParameters& parameters, std::size_t most);

/// Ring in equilibrium that moves to the nodes of a response surface and measures their values.
class SurfaceRing
{
public:
  SurfaceRing(const SurfaceParameters& parameters, JointModel model);

  SurfaceRing(const SurfaceRing&) = delete;  // ring_ has a pointer to model_
  SurfaceRing& operator=(const SurfaceRing&) = delete;

  /// Inserts the wave generator at the motor and output angle 0. @returns false if the insertion did not converge.
  bool insert();

  /// Moves to a motor angle and v = output angle - motor angle / ratio [rad]. @returns false if it has no equilibrium.
  bool moveTo(double motor_angle, double v);

  /// Moves like `moveTo` above, from a guess of the tooth points at the new position [m].
  bool moveTo(double motor_angle, double v, const Eigen::VectorXd& guess);

  /// Tooth points [m]. rates: after `measure`, derivatives of these points by the motor angle at constant v [m/rad].
  const Eigen::VectorXd& points() const noexcept { return ring_.shape().points; }
  Eigen::VectorXd rates() const { return ring_.byWaveGenerator() + ring_.byOutput() / ratio_; }

  /// Values of a node at the present position.
  SurfaceNode measure();

  /// Writes the values of a node of a ToothResponse. `values`: storage for all quantities of the solved teeth.
  void measureTeeth(float* values) const noexcept;
  int teeth() const noexcept { return ring_.shape().teeth(); }
  int solvedTeeth() const noexcept
  {
    return ring_.shape().solved;
  }  ///< number of solved teeth: half of the teeth if the other half is equal; valid after `insert`

  double motorAngle() const noexcept { return ring_.position().wave_generator_angle; }  ///< present motor angle [rad]
  double pitch() const noexcept { return pitch_; }                                      ///< tooth pitch [rad]
  double ratio() const noexcept { return ratio_; }                                      ///< nominal ratio [-]
  /// The larger one of the torque limits of load and motor, both at the output [N.m]. The motor's limit is at most
  /// COLLISION_MARGIN times the momentary peak torque.
  double torqueLimit() const noexcept { return torque_limit_; }
  const JointModel& model() const noexcept { return model_; }
  JointModel& editModel() noexcept { return model_; }  ///< may be called between two moves
  /// Force of the wave generator on each tooth at the present position [N].
  const Eigen::VectorXd& contactForce() const noexcept { return ring_.forces().of<WaveGeneratorContact>().force; }

  /// Change of v from no load by a torque at the output, with the softest slope of the cup [rad].
  double twist(double torque) const noexcept { return torque / softest_; }

  /// Tolerance of a table's output torque at a node [N.m]: the torque that twists the gear by ANGLE_TOLERANCE.
  double outputTolerance(const SurfaceNode& node) const noexcept;

  /// Tolerance of a table's motor torque at a node [N.m]: 1e-4 of the motor's torque limit or, if this limit is 0, of
  /// the load's torque limit over the ratio. Larger above the torque limit.
  double motorTolerance(const SurfaceNode& node) const noexcept;

  /// Tolerance of a table's friction at the motor [N.m]: the tolerance of the motor torque. For a wave generator on
  /// balls the tolerance is at least 1 % of the friction, because a tooth that begins to touch changes all derivatives
  /// of the tooth points by some per cent, which no grid resolves.
  double frictionTolerance(const SurfaceNode& node) const noexcept;

  /// Friction torque of ring and bearing at the motor near standstill, with the static friction of the flanks [N.m].
  double frictionTorque(const SurfaceNode& node) const noexcept;

  /// Friction torque of the flanks at the motor, divided by the coefficient of friction [N.m].
  static double flankFriction(const SurfaceNode& node) noexcept;

  /// Number of tooth pitches after which the gear repeats at constant v, by torques at loads of both signs, sampled
  /// once in each pitch. It is 1 for equal teeth, that of half a turn or a turn of the wave generator if teeth of the
  /// flexspline differ, and one or two more if teeth of the circular spline differ. 0: none of these.
  int repetition();

  /// Whether the gear has mirror symmetry, by samples at three loads: at opposite motor angles and loads the friction
  /// is equal and the torques are opposite. False if the ring has no equilibrium at a sample.
  bool isMirrored();

  int solves() const noexcept { return solves_; }

  /// Factor on the tolerances at a node [-]: 1 up to the torque limit, 10 above this limit.
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
  double motor_limit_;  // torque that motorTolerance is a share of [N.m]
  double softest_;      // softest slope of the cup [N.m/rad]
  double static_friction_;
  double temperature_;
  int solves_{};
};
}  // namespace hjt
