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
/// Path of a flexspline tooth through its space. The path is a cycloid, that of a tooth on an inextensible ring whose
/// motion at the major axis is conjugate to the circular spline.
///
///   drop   = w0 (1 - cos tau)              from full engagement, along the axis of the space  [m]
///   across = (a / 2) (tau - sin tau)       a = (r0 + z_t) (Z_CS - Z_FS) / Z_CS                [m]
///
/// where tau = 2 psi, psi = angle of the tooth from the major axis [rad]; w0 = gear.wave_amplitude, r0 = inner radius
/// of the rim, z_t = height of a tooth's middle above it [m]; Z_CS, Z_FS = teeth of circular spline and flexspline. The
/// path follows from the wave w0 cos 2 psi, the displacement -(w0/2) sin 2 psi of the rim, the tilt of the tooth and
/// the pitches.
class EngagementPath
{
public:
  explicit EngagementPath(const GearParameters& gear);

  double across(double drop) const noexcept;
  double slope(double drop) const noexcept;         ///< derivative of `across` by the drop; 0 at full engagement [-]
  double entry() const noexcept { return entry_; }  ///< drop at which the tip leaves the circular spline [m]

private:
  double tau(double drop) const noexcept;

  double amplitude_;
  double travel_;
  double entry_;
};

/// Flanks of a flexspline tooth and of its space, at points `step` apart. All half thicknesses and half widths have an
/// arbitrary additive constant, which the clearance at full engagement determines (thesis section 3.2).
///
/// trapezoid   straight flanks at the flank angle.
/// involute    the flanks of two rigid gears with equal base pitch. The pressure angle is the flank angle at mid-height
///             of the tooth at rest.
/// cycloid     each flank is the path of the tooth at half scale, for the space turned by 180 degrees. These flanks
///             touch along the whole path (Ishikawa's similar curves).
/// double_arc  tooth: a straight tangent at mid-height, a convex arc above and a concave arc below. Their radius gives
///             the tip the slope of the path at entry. Space: the envelope of the tooth along the path.
struct FlankShapes
{
  /// `intervals`: number of steps from entry to full engagement. The space has `beyond` additional steps.
  FlankShapes(const MeshParameters& mesh, const GearParameters& gear, int intervals, int beyond);

  double step;            ///< distance between points [m]
  Eigen::VectorXd tooth;  ///< half thickness at points from the tip inwards [m]
  Eigen::VectorXd space;  ///< half width at points from the circular spline's tip circle outwards [m]
};

/// Half clearance between a flexspline tooth and its space, with its derivatives.
struct HalfClearance
{
  double value;      ///< half clearance; < 0: interference [m]
  double slope;      ///< minus the derivative of `value` along the axis of the space: tangent of the flank's angle [-]
  double curvature;  ///< derivative of `slope` along the axis of the space [1/m]
  double cosine;     ///< cosine of the flank's angle [-]
};

/// Half clearance as a function of zeta, the distance of the tooth along the axis of its space, by thesis section 3.2.
///
/// trapezoid:  c(zeta) = c0 + (r0 + z_t + w0 - zeta) tan(beta), in closed form
/// others:     c(zeta) = c0 + min over y of [s(zeta + y) - t(y)], minus its value at full engagement
/// where       c0      half clearance at full engagement, zeta = r0 + z_t + w0       [m]
///             beta    flank angle                                                   [rad]
///             r0, z_t, w0  see EngagementPath                                           [m]
///             t, s    half thickness of the tooth at height y, half width of its space; y is within
///                     their common height                                               [m]
///
/// A table holds the minimum from entry to a little beyond full engagement. A C2 spline, straight at its ends,
/// interpolates the table.
class ToothProfile
{
public:
  ToothProfile(const MeshParameters& mesh, const GearParameters& gear);

  HalfClearance at(double zeta) const noexcept
  {
    return straight() ? HalfClearance{ straightAt(zeta), slope_, 0.0, cosine_ } : tabled(zeta);
  }

  /// Half clearance without derivatives.
  double value(double zeta) const noexcept { return straight() ? straightAt(zeta) : place(zeta).value(); }

  /// Whether the half clearance has the closed form `straightAt`.
  bool straight() const noexcept { return cubics_.empty(); }
  double straightAt(double zeta) const noexcept { return clearance_ + (full_engagement_ - zeta) * slope_; }

private:
  /// Interval of the table that contains zeta.
  struct Place
  {
    const std::array<double, 4>& cubic;
    double u;       // distance from the start of the interval [m]
    double beyond;  // distance of zeta beyond an end of the table; 0 within the table, < 0 before its start [m]

    double rise() const noexcept { return cubic[1] + u * (2.0 * cubic[2] + 3.0 * u * cubic[3]); }
    double value() const noexcept
    {
      return cubic[0] + u * (cubic[1] + u * (cubic[2] + u * cubic[3])) + beyond * rise();
    }
  };
  Place place(double zeta) const noexcept
  {
    const double along = zeta - start_;
    const double inside = along > 0.0 ? std::min(along, end_) : 0.0;  // 0 for NaN
    const std::size_t i = std::min(static_cast<std::size_t>(inside * intervals_per_metre_), cubics_.size() - 1);
    return { cubics_[i], inside - interval_ * static_cast<double>(i), along - inside };
  }
  HalfClearance tabled(double zeta) const noexcept;

  double clearance_;
  double full_engagement_;
  double slope_;
  double cosine_;
  double start_{};     // start of the table [m]
  double end_{};       // length of the table [m]
  double interval_{};  // length of an interval of the table [m]
  double intervals_per_metre_{};
  // for each interval the coefficients of the half clearance as a cubic of the distance from the interval's start
  std::vector<std::array<double, 4>> cubics_;
};
}  // namespace hjt
