// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

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
/// involute    both gears cut as rigid ones: same base pitch, pressure angle = flank angle at mid-height of the tooth
///             at rest.
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

/// Half clearance between a flexspline tooth and its space, with its derivatives.
struct HalfClearance
{
  double value;      ///< < 0: interference [m]
  double slope;      ///< minus the derivative along the axis of the space: tangent of the flank's angle there [-]
  double curvature;  ///< derivative of the slope [1/m]
  double cosine;     ///< of the flank's angle there [-]
};

/// Half clearance over zeta, the tooth's distance along the axis of its space, for each profile of thesis §3.2.
///
/// trapezoid:  c(zeta) = c0 + (r0 + z_t + w0 - zeta) tan(beta), in closed form
/// others:     c(zeta) = c0 + min over y of [s(zeta + y) - t(y)], less the same at full engagement
/// where       c0      half clearance at full engagement, zeta = r0 + z_t + w0       [m]
///             beta    flank angle                                                   [rad]
///             t, s    half thickness of the tooth at the height y, half width of its space,
///                     the minimum taken where the two lie beside each other         [m]
///
/// The minimum is tabled over the engagement and a little beyond, and joined by a C2 spline that goes on straight.
class ToothProfile
{
public:
  ToothProfile(const MeshParameters& mesh, const GearParameters& gear);

  HalfClearance at(double zeta) const noexcept
  {
    return straight() ? HalfClearance{ straightAt(zeta), slope_, 0.0, cosine_ } : tabled(zeta);
  }

  /// The half clearance alone.
  double value(double zeta) const noexcept { return straight() ? straightAt(zeta) : place(zeta).value(); }

  /// Closed form: the half clearance is `straightAt`.
  bool straight() const noexcept { return cubics_.empty(); }
  double straightAt(double zeta) const noexcept { return clearance_ + (full_engagement_ - zeta) * slope_; }

private:
  /// Interval of the table that zeta lies in.
  struct Place
  {
    const std::array<double, 4>& cubic;
    double u;       // from the start of its interval [m]
    double beyond;  // the table's ends, > 0 or < 0 [m]

    double rise() const noexcept { return cubic[1] + u * (2.0 * cubic[2] + 3.0 * u * cubic[3]); }
    double value() const noexcept
    {
      return cubic[0] + u * (cubic[1] + u * (cubic[2] + u * cubic[3])) + beyond * rise();
    }
  };
  Place place(double zeta) const noexcept
  {
    const double along = zeta - start_;
    const double inside = along > 0.0 ? std::min(along, end_) : 0.0;  // a number that is none has no interval either
    const std::size_t i = std::min(static_cast<std::size_t>(inside * intervals_per_metre_), cubics_.size() - 1);
    return { cubics_[i], inside - interval_ * static_cast<double>(i), along - inside };
  }
  HalfClearance tabled(double zeta) const noexcept;

  double clearance_;
  double full_engagement_;
  double slope_;
  double cosine_;
  double start_{};     // of the table [m]
  double end_{};       // distance from there [m]
  double interval_{};  // [m]
  double intervals_per_metre_{};
  std::vector<std::array<double, 4>> cubics_;  // of the half clearance, over the distance from each interval's start
};
}  // namespace hjt
