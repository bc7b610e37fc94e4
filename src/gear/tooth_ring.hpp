// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Tooth points of the flexspline on its inner rim at rest: a regular polygon of radius r0, tooth 0 on the x axis.
/// All vectors of the ring are interleaved: x of tooth i at 2i, y at 2i+1.
class ToothRing
{
public:
  explicit ToothRing(const GearParameters& gear)
    : pitch_angle_(TWO_PI / gear.teeth_flexspline)
    , segment_length_(2.0 * gear.flexspline_inner_radius * std::sin(0.5 * pitch_angle_))
    , points_(2 * gear.teeth_flexspline)
    , radial_(2 * gear.teeth_flexspline)
    , segments_(2 * gear.teeth_flexspline)
  {
    for (int i = 0; i < gear.teeth_flexspline; ++i)
    {
      const double angle = i * pitch_angle_;
      const double middle = angle + 0.5 * pitch_angle_;
      radial_.segment<2>(2 * i) << std::cos(angle), std::sin(angle);
      segments_.segment<2>(2 * i) << -std::sin(middle), std::cos(middle);
    }
    points_ = gear.flexspline_inner_radius * radial_;
  }

  int teeth() const noexcept { return static_cast<int>(points_.size()) / 2; }
  double pitchAngle() const noexcept { return pitch_angle_; }             ///< [rad]
  double segmentLength() const noexcept { return segment_length_; }       ///< tooth i to i+1 [m]
  const Eigen::VectorXd& points() const noexcept { return points_; }      ///< 2 N [m]
  const Eigen::VectorXd& radial() const noexcept { return radial_; }      ///< 2 N, unit vectors to each tooth [-]
  const Eigen::VectorXd& segments() const noexcept { return segments_; }  ///< 2 N, unit vectors from i to i+1 [-]

private:
  double pitch_angle_;
  double segment_length_;
  Eigen::VectorXd points_;
  Eigen::VectorXd radial_;
  Eigen::VectorXd segments_;
};
}  // namespace hjt
