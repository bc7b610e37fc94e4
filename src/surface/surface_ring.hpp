// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"
#include "solver/ring_equilibrium.hpp"

namespace hjt
{
/// The groups of a drive's parameters that a response surface is built with, beside its model.
struct SurfaceParameters
{
  SurfaceParameters(const Parameters& of);

  GearParameters gear;
  MeshParameters mesh;
  MeshParameters unit_friction;  ///< the mesh with coefficients of 1
  CupParameters cup;
  MotorParameters motor;
  OutputParameters output;
  InputParameters input;
  double momentary_peak_torque;  ///< [N.m]
};

/// No table of the ring has more: 85 MB; the shipped gear needs a tenth of it.
constexpr std::size_t MAX_SURFACE_POINTS = 500000;

/// Why there is no table of more than `most` points, with the parameters that its size depends on.
std::string tooManyPoints(const SurfaceParameters& parameters, std::size_t most);

/// A ring in equilibrium that is led over the nodes of a response surface and measured there.
class SurfaceRing
{
public:
  SurfaceRing(const SurfaceParameters& parameters, JointModel model);

  SurfaceRing(const SurfaceRing&) = delete;  // the ring refers to the model
  SurfaceRing& operator=(const SurfaceRing&) = delete;

  /// Solves at angle 0 of both, without a guess. False: not converged.
  bool insert();

  /// To v = output angle - motor angle / ratio [rad]. False: the ring found no equilibrium there.
  bool moveTo(double motor_angle, double v);

  /// The same, with initial tooth points as a guess.
  bool moveTo(double motor_angle, double v, const Eigen::VectorXd& guess);

  /// Tooth points, and after `measure` their rates by the motor's angle at the same v [m], [m/rad].
  const Eigen::VectorXd& points() const noexcept { return ring_.shape().points; }
  Eigen::VectorXd rates() const { return ring_.byWaveGenerator() + ring_.byOutput() / ratio_; }

  /// All values of a node at the present place.
  SurfaceNode measure();

  /// Those of a node of the ToothResponse; `values`: as many as the solved teeth have quantities.
  void measureTeeth(float* values) const noexcept;
  int teeth() const noexcept { return ring_.shape().teeth(); }
  int solvedTeeth() const noexcept
  {
    return ring_.shape().solved;
  }  ///< half of them, if the other half is the same; once inserted

  double motorAngle() const noexcept { return ring_.position().wave_generator_angle; }  ///< [rad]
  double pitch() const noexcept { return pitch_; }                                      ///< of the teeth [rad]
  double ratio() const noexcept { return ratio_; }                                      ///< nominal [-]
  /// Of load or motor, at the output; of a motor beyond what the gear bears in a collision, a quarter more than that
  /// [N.m].
  double torqueLimit() const noexcept { return torque_limit_; }
  const JointModel& model() const noexcept { return model_; }
  JointModel& editModel() noexcept { return model_; }  ///< between two moves
  /// Of the wave generator on each tooth, N, at the present place [N].
  const Eigen::VectorXd& contactForce() const noexcept { return ring_.forces().of<WaveGeneratorContact>().force; }

  /// Departure from no load that brings about this torque on the softest slope of the cup [rad].
  double twist(double torque) const noexcept { return torque / softest_; }

  /// Largest error of a table's output torque at a node: the torque of 0.002 seconds of arc [N.m].
  double outputTolerance(const SurfaceNode& node) const noexcept;

  /// The same for the motor's torque: a share of the motor's torque limit or, without one, of the load's limit
  /// reduced to the motor [N.m].
  double motorTolerance(const SurfaceNode& node) const noexcept;

  /// The same for the friction at the motor: as for its torque. On balls at least 1 % of the friction: each tooth that
  /// begins to touch changes the rates of all balls by some per cent, which no grid resolves [N.m].
  double frictionTolerance(const SurfaceNode& node) const noexcept;

  /// Friction of ring and bearing at the motor as the drive runs, slowly and with static flanks [N.m].
  double frictionTorque(const SurfaceNode& node) const noexcept;

  /// Of the flanks alone, per unit of their coefficient [N.m].
  static double flankFriction(const SurfaceNode& node) noexcept;

  /// Teeth that the gear must turn by to be the same again at the same v: 1 where all teeth are equal, half a turn or a
  /// whole one where those of one member differ; 0: none of these. As torques of both signs tell, sampled once a pitch.
  int repetition();

  /// Whether the gear is its own mirror image: same friction and opposite torques at opposite angles of both. As places
  /// at three loads tell. False also where one has no equilibrium.
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
  double softest_;      // slope of the cup [N.m/rad]
  double static_friction_;
  double temperature_;
  int solves_{};
};
}  // namespace hjt
