// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include <visualization_msgs/MarkerArray.h>

#include "harmonic_joint_twin/ContactForces.h"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "statics/flexspline_stress.hpp"

namespace hjt
{
/// How the drive is drawn.
struct MarkerStyle
{
  std::string frame;    ///< of the markers: the drive's axis is its z axis
  double exaggeration;  ///< radial distances from the middle of the engaged teeth are drawn this many times as long [-]
  double arrow_length;  ///< of a force [m/N]
  double full_force;    ///< force of a tooth drawn in full colour [N]
};

/// The drive as seen along its axis, for rviz, out of one message of contact forces.
///
/// Points are where the message says, in the plane z = 0, with radii stretched. Teeth are drawn as plain trapezoids:
/// the flanks' shape is not shown.
///
/// | namespace of the marker | shows |
/// |---|---|
/// | `wave_generator` | its ellipse and major axis |
/// | `flexspline` | teeth, coloured by the force on the flank; rim, by the stress between its teeth |
/// | `circular_spline` | ring and teeth |
/// | `wave_generator_force` | arrow onto every tooth that it presses, along the rim's normal |
/// | `leading_flank_force`, `trailing_flank_force` | arrow onto every loaded flank, along its normal |
/// | `loads` | teeth loaded and largest forces, as text |
class DriveMarkers
{
public:
  DriveMarkers(const Parameters& parameters, const MarkerStyle& style);

  const MarkerStyle& style() const { return style_; }
  void setStyle(const MarkerStyle& style) { style_ = style; }

  /// @throws std::invalid_argument unless every array has as many entries as the flexspline has teeth.
  visualization_msgs::MarkerArray draw(const harmonic_joint_twin::ContactForces& forces) const;

private:
  struct Teeth;

  std::pair<visualization_msgs::Marker, visualization_msgs::Marker> drawWaveGenerator(const std_msgs::Header& header,
                                                                                      double angle) const;
  void drawTooth(const harmonic_joint_twin::ContactForces& forces, std::size_t i, Teeth& teeth) const;
  visualization_msgs::Marker drawCircularSpline(const std_msgs::Header& header, double output_angle) const;

  GearParameters gear_;
  double flank_angle_;
  FlexsplineStress stress_;
  double full_stress_;  // nominal, the endurance limit at the notch [Pa]
  MarkerStyle style_;
  double fixed_radius_;  // drawn where it is [m]
};
}  // namespace hjt
