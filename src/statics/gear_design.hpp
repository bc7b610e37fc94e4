// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Conditions under which a catalogue states its friction torques.
constexpr double CATALOGUE_SPEED = 2000.0 * PI / 30.0;  // [rad/s]
constexpr double CATALOGUE_TEMPERATURE = 20.0;          // [degC]
constexpr int FRICTION_POSITIONS = 8;                   // wave generator angles in a pitch for mean friction

/// Request for a gear. A value that the request lacks follows from the size.
struct GearRequest
{
  double size{ 25.0 };  ///< size in a catalogue's numbers: 25 has the configured dimensions [-]
  int ratio{ 100 };     ///< ratio with the circular spline held: half the number of the flexspline's teeth [-]
  std::optional<double> bore_radius;    ///< bore radius of the flexspline [m]
  std::optional<double> rim_thickness;  ///< thickness of the rim [m]
  std::optional<double> face_width;     ///< face width of the teeth [m]
  // Figures of the gear's own catalogue; empty: figures of the family HFUS/CSF.
  std::vector<double> stiffness;          ///< K1, K2, K3 of the whole gear [N.m/rad]
  std::vector<double> breakpoints;        ///< T1, T2 [N.m]
  std::vector<double> ratings;            ///< rated, average, repeated peak and momentary peak torque [N.m]
  std::optional<double> starting_torque;  ///< starting torque at the wave generator at 20 degC [N.m]
  std::optional<double> no_load_torque;   ///< no-load torque at the wave generator at 2000 rpm and 20 degC [N.m]
};

/// Figures of a maker's catalogue for a gear; 0: not known.
struct GearFigures
{
  std::array<double, 3> stiffness{};    ///< K1, K2, K3 of the whole gear [N.m/rad]
  std::array<double, 2> breakpoints{};  ///< T1, T2 [N.m]
  double rated_torque{};                ///< [N.m]
  double average_torque{};              ///< [N.m]
  double repeated_peak_torque{};        ///< [N.m]
  double momentary_peak_torque{};       ///< [N.m]
  double starting_torque{};             ///< starting torque at the wave generator at 20 degC [N.m]
  double no_load_torque{};              ///< no-load torque at the wave generator at 2000 rpm and 20 degC [N.m]
  std::string source;                   ///< source of the figures that the request lacks

  double torsion(double torque) const;  ///< torsion [rad] by the catalogue under a torque >= 0 [N.m]
};

/// Figures of the request, completed by the catalogue of the family HFUS/CSF. If the catalogue lacks the ratio, the
/// function uses the closest ratio of the size. If the catalogue lacks the size, the function scales size 25.
/// @throws ParameterError if a given figure is impossible for a gear.
GearFigures gearFigures(const GearRequest& request);

/// Key of a parameter of the gear, with the rule that gave the parameter its value.
struct DesignedParameter
{
  std::string key;
  std::string rule;
};

/// A designed gear. Rules of similarity scale every configured parameter that depends on size, teeth or rim. The cup's
/// stiffnesses, the race preload and the viscosity are then fitted to the figures of the catalogue.
struct GearDesign
{
  ParameterMap map;  ///< complete configuration
  std::vector<DesignedParameter> parameters;
};

/// Designs a gear. `configured`: complete configuration of HFUS-25-2SH with ratio 100, or of a variant.
/// @throws ParameterError if parameters are out of range or the gear has no equilibrium.
GearDesign designGear(const ParameterMap& configured, const GearRequest& request, const GearFigures& figures);
}  // namespace hjt
