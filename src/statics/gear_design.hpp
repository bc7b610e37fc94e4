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
/// Conditions under which a catalogue gives its torques of friction.
constexpr double CATALOGUE_SPEED = 2000.0 * PI / 30.0;  // [rad/s]
constexpr double CATALOGUE_TEMPERATURE = 20.0;          // [degC]
constexpr int FRICTION_POSITIONS = 8;                   // in a tooth pitch, over which friction is averaged

/// Requested gear. Values that are left out follow from the size.
struct GearRequest
{
  double size{ 25.0 };                  ///< as catalogues count: 25 has the configured dimensions [-]
  int ratio{ 100 };                     ///< with the circular spline held: half the flexspline's teeth [-]
  std::optional<double> bore_radius;    ///< of the flexspline [m]
  std::optional<double> rim_thickness;  ///< [m]
  std::optional<double> face_width;     ///< of the teeth [m]
  // Figures of a catalogue of its own; empty: as far as known.
  std::vector<double> stiffness;          ///< K1, K2, K3 of the whole gear [N.m/rad]
  std::vector<double> breakpoints;        ///< T1, T2 [N.m]
  std::vector<double> ratings;            ///< rated, average, repeated peak, momentary peak torque [N.m]
  std::optional<double> starting_torque;  ///< at the wave generator, 20 degC [N.m]
  std::optional<double> no_load_torque;   ///< at the wave generator, 2000 rpm, 20 degC [N.m]
};

/// Figures of a maker's catalogue for a gear; 0: not given.
struct GearFigures
{
  std::array<double, 3> stiffness{};    ///< K1, K2, K3 of the whole gear [N.m/rad]
  std::array<double, 2> breakpoints{};  ///< T1, T2 [N.m]
  double rated_torque{};                ///< [N.m]
  double average_torque{};              ///< [N.m]
  double repeated_peak_torque{};        ///< [N.m]
  double momentary_peak_torque{};       ///< [N.m]
  double starting_torque{};             ///< at the wave generator, 20 degC [N.m]
  double no_load_torque{};              ///< at the wave generator, 2000 rpm, 20 degC [N.m]
  std::string source;                   ///< source of the figures that were not given

  double torsion(double torque) const;  ///< [rad], of a torque >= 0 [N.m]
};

/// Figures of the request; else those of the catalogue of the family HFUS/CSF. A ratio that it does not have is scaled
/// from the next ratio of that size, a size that it does not have from size 25.
/// @throws ParameterError if a given figure is none that a gear can have.
GearFigures gearFigures(const GearRequest& request);

/// A parameter of the gear and the rule by which it follows from the configured gear.
struct DesignedParameter
{
  std::string key;
  std::string rule;
};

/// A gear of the family: every parameter of the configured one that depends on size, teeth or rim, by rules of
/// similarity; then slopes of the cup, race preload and viscosity fitted to the figures.
struct GearDesign
{
  ParameterMap map;  ///< whole
  std::vector<DesignedParameter> parameters;
};

/// `configured`: HFUS-25-2SH, ratio 100, or a variant of it, whole.
/// @throws ParameterError if the parameters leave their ranges, or the gear has no equilibrium.
GearDesign designGear(const ParameterMap& configured, const GearRequest& request, const GearFigures& figures);
}  // namespace hjt
