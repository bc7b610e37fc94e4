// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elements/ring_forces.hpp"
#include "gear/ring_shape.hpp"
#include "gear/tooth_ring.hpp"

namespace hjt
{
/// Bending stiffness of the flexspline rim.
///
/// Energy:  absolute   U = 1/2 sum_i k_i eta_i^2                 (thesis eq. 5.47-5.53; not frame-indifferent)
///          curvature  U = 1/2 sum_i k_i (eta_i - eta_{i-1})^2   (frame-indifferent)
/// where    eta_i  rotation of the segment from tooth i to i+1 from rest [rad]
///          k_i    stiffness, >= 0                                       [N.m/rad]
/// A rim that has been bent for good adds its own angle: less preset_i, what the brackets would be of themselves.
class RimBending
{
public:
  RimBending(const RingParameters& parameters, const ToothRing& rest);

  void addForces(const RingShape& shape, RingForces& forces) const noexcept;
  /// `forces`: of the same shape.
  void addTangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept;

  /// Force of the couple that turns segment i back, at its ends (thesis eq. 5.52) [N].
  double bendingForce(const RingShape& shape, const RingForces& forces, int i) const noexcept
  {
    const double next = law_ == BendingLaw::ABSOLUTE ? 0.0 : forces.bending_moment[shape.next(i)];
    return (forces.bending_moment[i] - next) / shape.lengths[i];
  }

  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }  ///< N, editable per tooth [N.m/rad]
  Eigen::VectorXd& preset() noexcept { return preset_; }        ///< N, editable per tooth [rad]

private:
  void addMoments(const RingShape& shape, RingForces& forces) const noexcept;
  void addTurnTangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept;
  void addCurvatureTangent(const RingShape& shape, RingTangent& tangent) const noexcept;

  BendingLaw law_;
  Eigen::VectorXd stiffness_;
  Eigen::VectorXd preset_;
  Eigen::VectorXd rest_directions_;
  double rest_cos_;  // of the angle between neighbouring segments at rest
  double rest_sin_;
};
}  // namespace hjt
