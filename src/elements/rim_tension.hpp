// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elements/force_sum.hpp"
#include "elements/ring_tangent.hpp"
#include "gear/ring_shape.hpp"
#include "gear/tooth_ring.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Axial stiffness of the flexspline rim between neighbouring teeth (thesis eq. 5.33-5.34, the missing plus put in).
///
/// Energy:  U = 1/2 sum_i k_i (d_i - d0)^2
/// where    d_i  distance between tooth points i and i+1   [m]
///          d0   the same at rest                          [m]
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

  /// Tension of segment i, pull > 0 [N].
  double tension(const RingShape& shape, int i) const noexcept
  {
    return stiffness_[i] * (shape.lengths[i] - rest_length_);
  }

  const Eigen::VectorXd& stiffness() const noexcept { return stiffness_; }
  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }  ///< N, editable per segment [N/m]

private:
  Eigen::VectorXd stiffness_;
  double rest_length_;
};
}  // namespace hjt
