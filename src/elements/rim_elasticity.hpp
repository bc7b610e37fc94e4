// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elements/ring_sums.hpp"
#include "gear/ring_shape.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Axial stiffness of the rim between neighbouring teeth (thesis eq. 5.33-5.34 with a missing plus sign added).
///
/// Energy:  U = 1/2 sum_i k_i (d_i - d0)^2
/// where    d_i  distance between tooth points i and i+1   [m]
///          d0   distance of two tooth points at rest      [m]
///          k_i  stiffness of segment i, >= 0; 0 = cut rim [N/m]
class RimTension
{
public:
  RimTension(const Parameters& parameters, const ToothRing& rest);

  struct Scratch
  {
    explicit Scratch(int /*teeth*/) {}
    void setZero() noexcept {}
    void repeat() noexcept {}
  };
  void addForces(const RingShape& shape, const DrivePosition&, Scratch&, ForceSum& sum) const noexcept;
  void addTangent(const RingShape& shape, const Scratch&, RingTangent& tangent) const noexcept;
  bool repeats() const noexcept { return halvesAgree(stiffness_); }

  /// Tension of segment i [N]; > 0: the segment pulls at its ends.
  double tension(const RingShape& shape, int i) const noexcept
  {
    return stiffness_[i] * (shape.lengths[i] - rest_length_);
  }

  const Eigen::VectorXd& stiffness() const noexcept { return stiffness_; }
  /// stiffness of each segment, which faults change [N/m]
  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }

private:
  Eigen::VectorXd stiffness_;
  double rest_length_;
};

/// Bending stiffness of the flexspline rim and of the bearing's outer race, which bends with the rim.
///
/// Energy:  absolute   U = 1/2 sum_i (k_i + k_race) eta_i^2                (thesis eq. 5.47-5.53; grounded)
///          curvature  U = 1/2 sum_i (k_i + k_race) (eta_i - eta_{i-1})^2  (frame-indifferent)
/// where    eta_i   rotation of the segment from tooth i to i+1 from rest [rad]
///          k_i     stiffness of the rim, >= 0                            [N.m/rad]
///          k_race  stiffness of the race, equal at all teeth                     [N.m/rad]
/// A permanently bent rim has a natural angle. This angle is subtracted from eta_i (absolute law) or eta_i - eta_{i-1}
/// (curvature law) in the term of k_i, but not in that of k_race.
class RimBending
{
public:
  RimBending(const Parameters& parameters, const ToothRing& rest);

  struct Scratch
  {
    explicit Scratch(int teeth) : moment(teeth) {}
    void setZero() noexcept {}  // nothing to do, because `addForces` writes every entry
    void repeat() noexcept { repeatHalf(moment); }

    Eigen::VectorXd moment;  ///< bending moment at each tooth (absolute law: of each segment) [N.m]
  };
  void addForces(const RingShape& shape, const DrivePosition&, Scratch& scratch, ForceSum& sum) const noexcept;
  void addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept;
  bool repeats() const noexcept { return halvesAgree(stiffness_) && halvesAgree(natural_angle_); }

  /// Force at each end of segment i; the two forces are the restoring couple of the segment (thesis eq. 5.52) [N].
  double bendingForce(const RingShape& shape, const Scratch& scratch, int i) const noexcept
  {
    const double next = law_ == BendingLaw::ABSOLUTE ? 0.0 : scratch.moment[shape.next(i)];
    return (scratch.moment[i] - next) / shape.lengths[i];
  }

  const Eigen::VectorXd& stiffness() const noexcept { return stiffness_; }
  /// stiffness of the rim without the race at each tooth, which faults change [N.m/rad]
  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }
  const Eigen::VectorXd& naturalAngle() const noexcept { return natural_angle_; }
  /// natural angle at each tooth, which faults change [rad]
  Eigen::VectorXd& naturalAngle() noexcept { return natural_angle_; }

private:
  void addMoments(const RingShape& shape, Scratch& scratch, ForceSum& sum) const noexcept;
  void addTurnTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept;
  void addCurvatureTangent(const RingShape& shape, RingTangent& tangent) const noexcept;

  BendingLaw law_;
  Eigen::VectorXd stiffness_;
  double race_;  // stiffness of the race [N.m/rad]
  Eigen::VectorXd natural_angle_;
  Eigen::VectorXd rest_directions_;
  double rest_cos_;  // cosine of the angle between neighbouring segments at rest
  double rest_sin_;
};
}  // namespace hjt
