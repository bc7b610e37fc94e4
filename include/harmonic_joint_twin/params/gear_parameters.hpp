// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

namespace hjt
{
/// @file Sections of the configuration that describe the gear. docs/parameters.md gives units and ranges.

struct GearParameters
{
  int teeth_flexspline{};
  int teeth_circular_spline{};
  double flexspline_inner_radius{};
  double wave_amplitude{};
  double rim_thickness{};
  double tooth_height_flexspline{};
  double tip_radius_circular_spline{};

  /// Distance from the inner rim to mid-height of a tooth [m].
  double toothMidHeight() const { return rim_thickness + 0.5 * tooth_height_flexspline; }

  /// Overlap of a flexspline tooth with the circular spline at the major axis [m].
  double engagementDepth() const
  {
    return flexspline_inner_radius + wave_amplitude + rim_thickness + tooth_height_flexspline -
           tip_radius_circular_spline;
  }
};

/// Rotation that the bending stiffness of the rim resists: the rotation of each segment from rest (thesis 5.47-5.53),
/// or the rotation between neighbouring segments.
enum class BendingLaw
{
  ABSOLUTE,
  CURVATURE
};

struct RingParameters
{
  double mass{};
  double tension_stiffness{};
  double tension_damping{};
  double tooth_damping{};
  double bending_stiffness{};
  BendingLaw bending_law{};
  double loss_factor{};
};

/// Direction of the wave generator's force: normal at the tooth's polar angle (thesis eq. 5.11), or true normal.
enum class ContactLaw
{
  POLAR,
  NORMAL
};

/// How the wave generator supports the rim.
enum class SupportKind
{
  SPRINGS,      ///< a spring at each tooth, on a rigid ellipse
  BALLS,        ///< the balls of the bearing by Hertz' law, spread evenly around the ring
  SINGLE_BALLS  ///< each ball of the bearing by Hertz' law, at its own angle
};

struct ContactParameters
{
  SupportKind support{};
  double stiffness{};
  double fit{};
  double temperature_difference{};
  double damping{};
  ContactLaw law{};
  double smoothing{};
  double friction_coefficient{};
  double slip_lever{};
};

/// Shape of the flanks of the teeth, thesis section 3.2.
enum class ProfileKind
{
  TRAPEZOID,
  INVOLUTE,
  CYCLOID,
  DOUBLE_ARC
};

struct MeshParameters
{
  ProfileKind profile{};
  double stiffness{};
  double flank_angle{};
  double tangent_angle{};
  double tangent_length{};
  double flank_clearance{};
  double engagement_depth{};
  double smoothing{};
  double friction_static{};
  double friction_kinetic{};
  double stribeck_velocity{};
};

/// Value that says "no file", of a parameter that can name a file.
constexpr const char* NO_FILE = "none";

/// Pitch errors of the flexspline or the circular spline, from a random sequence with a seed or from a table.
struct PitchParameters
{
  double deviation{};
  int seed{};
  std::string table{};
};

struct ManufactureParameters
{
  PitchParameters flexspline_pitch;
  PitchParameters circular_spline_pitch;
  std::array<double, 2> flexspline_eccentricity{};
  std::array<double, 2> circular_spline_eccentricity{};
  std::array<double, 2> circular_spline_ellipticity{};
  std::array<double, 2> wave_generator_eccentricity{};
  double wave_generator_ellipticity{};
};

struct CupParameters
{
  std::array<double, 3> torsion_stiffness{};
  std::array<double, 2> torsion_breakpoints{};
  double wall_stiffness{};
  double friction_torque{};
  double friction_angle{};
};

struct BearingParameters
{
  double lubricant_factor{};
  double load_factor{};
  double race_preload{};
  double race_bending_stiffness{};
  double pitch_diameter{};
  int balls{};
  double ball_diameter{};
  double cage_slip{};
  double viscosity{};
  double oil_viscosity{};
  double viscosity_temperature{};
  double viscosity_slope{};
  double constant_share{};
};
}  // namespace hjt
