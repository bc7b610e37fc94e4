// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Path of a flexspline tooth through its space, on an inextensible ring that is conjugate at its major axis: a
/// cycloid.
///
///   drop   = w0 (1 - cos tau)              from full engagement, along the axis of the space  [m]
///   across = (a / 2) (tau - sin tau)       a = (r0 + z_t) (Z_CS - Z_FS) / Z_CS                [m]
///
/// tau = 2 psi, psi the tooth's angle from the major axis. It follows from the wave w0 cos 2 psi, the rim's
/// displacement
/// -(w0/2) sin 2 psi with the tilt of the tooth, and the difference of the pitches.
class EngagementPath
{
public:
  explicit EngagementPath(const GearParameters& gear);

  double across(double drop) const noexcept;
  double slope(double drop) const noexcept;         ///< of `across` over `drop`, 0 at full engagement [-]
  double entry() const noexcept { return entry_; }  ///< drop at which the tip leaves the circular spline [m]

private:
  double tau(double drop) const noexcept;

  double amplitude_;
  double travel_;
  double entry_;
};

/// Flanks of a flexspline tooth and of its space, at points `step` apart; lengths up to a constant that the clearance
/// at full engagement settles (thesis §3.2).
///
/// trapezoid   straight flanks at the flank angle.
/// involute    both gears cut as rigid ones: same base pitch, pressure angle = flank angle at mid-height of the tooth at
///             rest.
/// cycloid     each flank the path of the tooth on half the scale, one the other turned by 180 degrees: such a pair
///             touches all along the path (Ishikawa's similar curves).
/// double_arc  tooth: tangent at mid-height, a convex arc above, a concave one of the same radius below, which is such
///             that the tip has the slope of the path where it enters. Space: envelope of that tooth along the path.
struct FlankShapes
{
  /// `intervals`: steps between entry and full engagement; the space is sampled `beyond` steps further.
  FlankShapes(const MeshParameters& mesh, const GearParameters& gear, int intervals, int beyond);

  double step;            ///< [m]
  Eigen::VectorXd tooth;  ///< half thickness, from the tip inwards, J [m]
  Eigen::VectorXd space;  ///< half width, from the circular spline's tip circle outwards, K [m]
};
}  // namespace hjt
