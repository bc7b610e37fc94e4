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
/// Torque:  C(Phi), an odd, piecewise linear function: slope K1 up to the torque T1, K2 up to T2, K3 above T2
/// where    Phi  mean rotation of the tooth points from rest, mean_i(psi_i - psi0_i) [rad]
///          psi_i, psi0_i  angle of tooth point i, now and at rest [rad]
///
/// The torque acts on the mean rotation. The thesis applies the torque to each tooth. The cup would then be too stiff
/// by a factor equal to the number of teeth, and would resist the travelling wave.
///
/// The curve C is that of the catalogue for the whole gear without the compliance of the model's rim, teeth and
/// bearing. The wall and the diaphragm of the cup contribute 1/K_W (cup.wall_stiffness) to the compliance of C. No
/// other part of the model represents the remaining compliance.
class CupTorsion
{
public:
  CupTorsion(const Parameters& parameters, const ToothRing& rest);

  /// Multiplies the stiffness of wall and diaphragm by `factor` > 0 [-]. T1, T2 and the remaining compliance of C stay.
  void scaleWall(double factor) noexcept;

  /// mean rotation Phi of the tooth points from rest [rad]
  double meanRotation(const RingShape& shape) const noexcept;
  /// Rate dPhi/dt of the mean rotation [rad/s]. `speeds`: x and y of the speed of each tooth point [m/s].
  static double meanRotationRate(const RingShape& shape, const Eigen::VectorXd& speeds) noexcept;
  double torque(double rotation) const noexcept;           ///< torque C(Phi) [N.m]
  double rotationAtTorque(double torque) const noexcept;   ///< inverse of C(Phi) [rad]
  double storedEnergy(double rotation) const noexcept;     ///< energy of the cup's torsion [J]
  double stiffness(double rotation) const noexcept;        ///< dC/dPhi [N.m/rad]
  double complianceAtTorque(double torque) const noexcept  ///< 1 / (dC/dPhi) [rad/(N.m)]
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

  double wall_compliance_;  // compliance of wall and diaphragm [rad/(N.m)]
  std::array<double, 3> slopes_;
  std::array<double, 3> compliances_{};  // 1 / slopes_ [rad/(N.m)]
  std::array<double, 2> torques_;
  std::array<double, 2> rotations_;  // mean rotations at the breakpoints [rad]
  Eigen::VectorXd rest_radial_;
};
}  // namespace hjt
