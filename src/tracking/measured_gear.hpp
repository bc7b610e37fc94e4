// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "harmonic_joint_twin/model/lobe_loads.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "model/joint_model.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/flexspline_stress.hpp"

namespace hjt
{
/// Gear of a measured joint, with all teeth in equilibrium at the measured angle of the joint under its present torque.
///
/// If all teeth are alike, the equilibrium is the same after the wave generator has turned by a tooth pitch p of the
/// flexspline and the output by p / ratio; only the numbers of the teeth change. The class then solves the ring within
/// one pitch and renumbers the teeth of the result. After construction nothing throws or allocates.
class MeasuredGear
{
public:
  /// @throws ParameterError if the wave generator cannot be inserted.
  explicit MeasuredGear(const Parameters& parameters);
  MeasuredGear(const MeasuredGear&) = delete;  // no copy, because the ring refers to the model
  MeasuredGear& operator=(const MeasuredGear&) = delete;

  /// Moves the gear to an angle of the joint [rad] and a torque of the mesh on the output [N.m]. Returns false, and
  /// keeps the angles, if a number is not finite, the torque exceeds output.load_torque_limit, or there is no
  /// equilibrium.
  bool moveTo(double position, double joint_torque) noexcept;

  double position() const noexcept { return position_; }       ///< angle of the joint [rad]
  double motorAngle() const noexcept { return motor_angle_; }  ///< angle of the wave generator [rad]
  double torsion() const noexcept
  {
    return motor_angle_ / ratio_ - position_;
  }  ///< motor angle / ratio - joint angle [rad]
  double stiffness() const noexcept
  {
    return ring_.stiffness()(1, 1);
  }  ///< torsional stiffness with the wave generator locked [N.m/rad]
  double residual() const noexcept { return residual_; }  ///< largest unbalanced force on a point of the ring [N]
  LobeLoads lobes() const noexcept;

  /// Writes the forces on the teeth to `forces`, which Twin::makeToothForces must have made.
  void fill(ToothForces& forces) const noexcept;
  /// Writes the stress at the teeth to `stress`, which must have the size for the gear's teeth.
  void fill(ToothStress& stress) const noexcept;

private:
  int firstTooth() const noexcept;
  bool solve(double motor_angle, double joint_torque) noexcept;

  const JointModel model_;
  RingEquilibrium ring_;
  const FlexsplineStress stress_;
  const bool teeth_are_alike_;
  const double pitch_;  // tooth pitch of the flexspline [rad]
  const double ratio_;
  const double torque_limit_;     // output.load_torque_limit [N.m]
  Eigen::VectorXd tooth_angles_;  // angles of the teeth at rest [rad]
  std::int64_t shift_{};          // number of pitches from the angles of ring_ to those of the drive
  double position_{};
  double motor_angle_{};
  double torsion_{};  // torsion of the ring [rad]
  bool is_lost_{};    // whether the last solution failed, so that ring_ is in no equilibrium
  double residual_{};
};
}  // namespace hjt
