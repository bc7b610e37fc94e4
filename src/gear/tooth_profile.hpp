// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
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
///             t, s    half thickness of the tooth at the height y, half width of its space (gear/flank_shapes.hpp),
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
