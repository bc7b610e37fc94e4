// SPDX-License-Identifier: BSD-3-Clause
#include "gear/tooth_ring.hpp"

#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
ToothRing::ToothRing(const GearParameters& gear)
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
}  // namespace hjt
