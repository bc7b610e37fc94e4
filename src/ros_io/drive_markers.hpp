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
struct MarkerStyle
{
  std::string frame;    ///< frame of the markers, whose z axis is the drive's axis
  double exaggeration;  ///< factor by which radial distances from the middle of the engaged teeth are drawn larger [-]
  double arrow_length;  ///< length of an arrow over the force that the arrow shows [m/N]
  double full_force;    ///< force from which a tooth has the full colour [N]
};

/// Markers for rviz of the drive, seen along its axis, from one message of contact forces.
///
/// The points of the message are drawn in the plane z = 0 with stretched radii. Teeth are trapezoids, which do not show
/// the shape of the flanks.
///
/// | namespace of the marker | shows |
/// |---|---|
/// | `wave_generator` | ellipse and major axis of the wave generator |
/// | `flexspline` | teeth, coloured by the force on the flank; rim, by the stress between its teeth |
/// | `circular_spline` | ring and teeth |
/// | `wave_generator_force` | arrow onto each tooth that the wave generator presses, along the rim's normal |
/// | `leading_flank_force`, `trailing_flank_force` | arrow onto each loaded flank, along the flank's normal |
/// | `loads` | text with the number of loaded teeth and the largest forces |
class DriveMarkers
{
public:
  DriveMarkers(const Parameters& parameters, const MarkerStyle& style);

  const MarkerStyle& style() const { return style_; }
  void setStyle(const MarkerStyle& style) { style_ = style; }

  /// @throws std::invalid_argument unless every array has one entry for each tooth of the flexspline.
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
  double full_stress_;  // nominal stress at which the rim has the full colour: the endurance limit at the notch [Pa]
  MarkerStyle style_;
  double fixed_radius_;  // radius that the stretching does not change [m]
};
}  // namespace hjt
