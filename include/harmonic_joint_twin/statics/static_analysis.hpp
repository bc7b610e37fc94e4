// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "harmonic_joint_twin/statics/tooth_stress.hpp"

namespace hjt
{
/// Positions, forces and stresses of every tooth in one equilibrium. The index is the tooth.
struct ToothTable
{
  std::vector<double> tooth_x;          ///< x of the tooth point [m]
  std::vector<double> tooth_y;          ///< y of the tooth point [m]
  std::vector<double> radius;           ///< distance of the tooth point from the axis [m]
  std::vector<double> angle_deviation;  ///< polar angle of the tooth point minus its angle at rest, psi - psi0 [rad]
  std::vector<double> wave_generator_force;  ///< force of the wave generator on the tooth [N]
  std::vector<double> rim_tension;           ///< tension of the rim to the next tooth [N]
  std::vector<double> bending_force;         ///< bending force of the segment to the next tooth [N]
  std::vector<double> mesh_force;            ///< normal force on the flank, > 0 leading, < 0 trailing flank [N]
  // Nominal normal stress at each place of the flexspline (ToothStress).
  std::vector<double> stress_tooth_space;  ///< stress in the tooth spaces on both sides of the tooth [Pa]
  std::vector<double> stress_transition;   ///< stress at the transition from the rim to the cup [Pa]
  std::vector<double> stress_flange;       ///< stress at the flange [Pa]
  // Position of the tooth in its space of the circular spline (ToothPlace).
  std::vector<double> across;  ///< distance of the tooth from the axis of its space [m]
  std::vector<double> depth;   ///< depth of the tooth's tip below the circular spline's tip circle [m]
  std::vector<double> tilt;    ///< angle of the tooth against the axis of its space [rad]
  std::vector<double> gap;     ///< distance of the tooth to the nearer flank; < 0 in contact [m]
};

/// Static equilibrium of the flexspline on the wave generator, without the circular spline (thesis ch. 5-6).
struct InsertionResult
{
  SolveStatus status;                 ///< status of the solve; the numbers are valid if ok()
  double wave_generator_force_max{};  ///< largest force of the wave generator on a tooth [N]
  double wave_generator_force_min{};  ///< least force of the wave generator on a tooth [N]
  double wave_generator_force_sum{};  ///< sum of the forces of the wave generator over all teeth [N]
  int teeth_in_contact{};             ///< number of teeth that touch the wave generator
  double tension_min{};               ///< least tension of the rim [N]
  double tension_max{};               ///< largest tension of the rim [N]
  double radius_major_axis{};         ///< radius of tooth 0, at the major axis [m]
  double radius_minor_axis{};         ///< radius of tooth N/4, at the minor axis [m]
  double bending_force_max{};         ///< largest bending force of a segment [N]
  double solve_time{};                ///< computing time [s]
  ToothTable teeth;                   ///< every tooth
};
/// Computes the insertion. If the solve fails, `status` is not ok() and the other numbers are invalid.
InsertionResult analyseInsertion(const Parameters& parameters);

/// Result of the check whether the teeth of flexspline and circular spline fit into each other without load.
struct FitCheck
{
  SolveStatus status;                       ///< status of both solves; the numbers are valid if ok()
  int teeth_loaded{};                       ///< number of teeth that carry mesh force without load
  double wave_generator_force{};            ///< sum of the wave generator's forces over the teeth, without load [N]
  double wave_generator_force_insertion{};  ///< sum of the wave generator's forces without circular spline [N]

  /// Whether the teeth jam, that is, load the wave generator more than twice as much as the bent rim alone does.
  bool jams() const noexcept { return status.ok() && wave_generator_force > 2.0 * wave_generator_force_insertion; }
};
/// Computes two insertions, without and with the circular spline. If a solve fails, `status` is not ok().
FitCheck checkFit(const Parameters& parameters);

/// Equilibrium with the wave generator locked and a load on the circular spline, without friction.
struct StiffnessRow
{
  SolveStatus status;     ///< status of the solve; the numbers are valid if ok()
  double torque{};        ///< load on the circular spline [N.m]
  double output_angle{};  ///< angle of the output minus its angle without load [rad]
  /// torque of the flexspline on the wave generator, about -torque over the ratio [N.m]
  double wave_generator_torque{};
  double housing_torque{};            ///< torque of the housing on the flexspline, through its cup [N.m]
  double cup_rotation{};              ///< mean rotation of the teeth from rest [rad]
  int teeth_loaded{};                 ///< number of teeth that carry mesh force
  double mesh_force_max{};            ///< largest mesh force of a tooth [N]
  double wave_generator_force_sum{};  ///< sum of the wave generator's forces over the teeth [N]
  /// force on each ball of the bearing [N]; empty unless contact.support is single balls
  std::vector<double> ball_force;
  ToothStress stress;  ///< stresses of the flexspline
  ToothTable teeth;    ///< every tooth
};
/// Returns one row for each torque, in the order of `torques`. Each solve starts without load, so the rows do not
/// depend on each other. `wave_generator_angle` [rad] and `torques` [N.m] may be any finite values. Torques act at the
/// output; torques > 0 resist positive motion. `status` of a row says whether its solve failed. Source: thesis 7.1-7.5.
std::vector<StiffnessRow> analyseStiffness(const Parameters& parameters, double wave_generator_angle,
                                           const std::vector<double>& torques);

/// Equilibrium at one angle of a quasi-static turn at constant load, without friction.
struct TurnRow
{
  SolveStatus status;             ///< status of the solve; the numbers are valid if ok()
  double wave_generator_angle{};  ///< angle of the wave generator [rad]
  double output_angle{};          ///< angle of the output [rad]
  double kinematic_error{};  ///< deviation of the output from the wave generator's angle over the nominal ratio [rad]
  double wave_generator_torque{};  ///< torque of the flexspline on the wave generator [N.m]
  double housing_torque{};         ///< torque of the housing on the flexspline, through its cup [N.m]
};
/// Returns `steps` + 1 rows at wave generator angles evenly spaced from 0 to `angle_range` [rad]. `load_torque` [N.m]
/// acts at the output. The function calls `progress` with each finished step. @throws InputError if steps < 1.
std::vector<TurnRow> analyseTurn(const Parameters& parameters, double load_torque, double angle_range, int steps,
                                 const std::function<void(int)>& progress);
}  // namespace hjt
