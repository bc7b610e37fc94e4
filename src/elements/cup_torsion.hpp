// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "elements/ring_sums.hpp"
#include "gear/ring_shape.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Torsion of the flexspline's cup between the toothed rim and the flange (thesis eq. 7.1-7.2).
///
/// Torque:  C(Phi), odd, piecewise linear: slope K1 up to torque T1, K2 up to T2, K3 beyond
/// where    Phi  mean rotation of the tooth points from rest, mean_i(psi_i - psi0_i) [rad]
///
/// The torque acts on the mean rotation. Taken per tooth, as the thesis writes it, the cup would be N times too stiff
/// and would resist the travelling wave.
///
/// The curve is the catalogue's for the whole gear less what rim, teeth and bearing of the model give way: a lumping.
/// Of its compliance 1/K_W is the wall's and diaphragm's; the rest has no place of its own in the model.
class CupTorsion
{
public:
  CupTorsion(const Parameters& parameters, const ToothRing& rest);

  /// Stiffness of wall and diaphragm times this, > 0; the rest of the compliance and the torques where the slope
  /// changes stay [-].
  void scaleWall(double factor) noexcept;

  double meanRotation(const RingShape& shape) const noexcept;  ///< Phi [rad]
  /// Rate of the mean rotation for speeds of the ring's points, 2 N [m/s]: dPhi/dt [rad/s].
  static double meanRotationRate(const RingShape& shape, const Eigen::VectorXd& speeds) noexcept;
  double torque(double rotation) const noexcept;           ///< C(Phi) [N.m]
  double rotationAtTorque(double torque) const noexcept;   ///< inverse of C [rad]
  double storedEnergy(double rotation) const noexcept;     ///< [J]
  double stiffness(double rotation) const noexcept;        ///< dC/dPhi [N.m/rad]
  double complianceAtTorque(double torque) const noexcept  ///< 1 / stiffness [rad/(N.m)]
  {
    const double size = torque < 0.0 ? -torque : torque;
    return size > torques_[1] ? compliances_[2] : size > torques_[0] ? compliances_[1] : compliances_[0];
  }

  struct Scratch
  {
    explicit Scratch(int /*teeth*/) {}
    void setZero() noexcept {}
    void repeat() noexcept {}

    double rotation{};  ///< mean rotation of the tooth points [rad]
  };
  void addForces(const RingShape& shape, const DrivePosition&, Scratch& scratch, ForceSum& sum) const noexcept;
  void addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept;
  static bool repeats() noexcept { return true; }

private:
  void placeBreakpoints() noexcept;

  double wall_compliance_;  // [rad/(N.m)]
  std::array<double, 3> slopes_;
  std::array<double, 3> compliances_{};  // 1 / slopes_
  std::array<double, 2> torques_;
  std::array<double, 2> rotations_;  // where the slope changes [rad]
  Eigen::VectorXd rest_radial_;
};
}  // namespace hjt
