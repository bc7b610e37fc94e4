// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Half clearance between a flexspline tooth and its space, over the tooth's distance along the axis of the space.
/// The straight flank of the trapezoid profile (thesis §3.2.1):
///
///   c(zeta) = c0 + (r0 + z_t + w0 - zeta) tan(beta)
///
/// c0 at full engagement, beta the flank angle. [m]
class StraightFlank
{
public:
  StraightFlank(const MeshParameters& mesh, const GearParameters& gear)
    : clearance_(mesh.flank_clearance)
    , full_engagement_(gear.flexspline_inner_radius + gear.toothMidHeight() + gear.wave_amplitude)
    , slope_(std::tan(mesh.flank_angle))
  {
  }

  double halfClearance(double zeta) const noexcept { return clearance_ + (full_engagement_ - zeta) * slope_; }

  /// Minus the derivative of the half clearance by zeta: tan(beta) [-].
  double slope() const noexcept { return slope_; }

private:
  double clearance_;
  double full_engagement_;
  double slope_;
};
}  // namespace hjt
