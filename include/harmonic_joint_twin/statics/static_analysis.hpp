// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "harmonic_joint_twin/statics/tooth_stress.hpp"

namespace hjt
{
/// Every tooth of one equilibrium, index = tooth.
struct ToothTable
{
  std::vector<double> tooth_x;               ///< of the tooth point [m]
  std::vector<double> tooth_y;               ///< of the tooth point [m]
  std::vector<double> radius;                ///< of the tooth point [m]
  std::vector<double> angle_deviation;       ///< psi - psi0 [rad]
  std::vector<double> wave_generator_force;  ///< [N]
  std::vector<double> rim_tension;           ///< to the next tooth [N]
  std::vector<double> bending_force;         ///< of the segment to the next tooth [N]
  std::vector<double> mesh_force;            ///< normal force on the flank, > 0 leading, < 0 trailing flank [N]
  // Nominal normal stress by place, see ToothStress.
  std::vector<double> stress_tooth_space;  ///< [Pa]
  std::vector<double> stress_transition;   ///< [Pa]
  std::vector<double> stress_flange;       ///< [Pa]
  // Where it stands in its space of the circular spline, see ToothPlace.
  std::vector<double> across;  ///< [m]
  std::vector<double> depth;   ///< [m]
  std::vector<double> tilt;    ///< [rad]
  std::vector<double> gap;     ///< [m]
};

/// Static equilibrium after the insertion, circular spline left out (thesis ch. 5-6).
struct InsertionResult
{
  SolveStatus status;                 ///< the numbers hold if ok()
  double wave_generator_force_max{};  ///< [N]
  double wave_generator_force_min{};  ///< [N]
  double wave_generator_force_sum{};  ///< [N]
  int teeth_in_contact{};             ///< with the wave generator
  double tension_min{};               ///< [N]
  double tension_max{};               ///< [N]
  double radius_major_axis{};         ///< of tooth 0 [m]
  double radius_minor_axis{};         ///< of tooth N/4 [m]
  double bending_force_max{};         ///< [N]
  double solve_time{};                ///< [s]
  ToothTable teeth;                   ///< every tooth
};
/// A solve that fails is told by `status`; the other numbers mean nothing then.
InsertionResult analyseInsertion(const Parameters& parameters);

/// Whether the teeth have room where the gear carries no load.
struct FitCheck
{
  SolveStatus status;                       ///< the numbers hold if ok()
  int teeth_loaded{};                       ///< without load
  double wave_generator_force{};            ///< sum over the teeth, without load [N]
  double wave_generator_force_insertion{};  ///< the same without the circular spline [N]

  /// The teeth press harder on the wave generator than the bent rim does.
  bool jams() const noexcept { return status.ok() && wave_generator_force > 2.0 * wave_generator_force_insertion; }
};
/// Two insertions, without and with the circular spline; a solve that fails is told by `status`.
FitCheck checkFit(const Parameters& parameters);

/// Wave generator locked, load on the circular spline, friction left out.
struct StiffnessRow
{
  SolveStatus status;                 ///< the numbers hold if ok()
  double torque{};                    ///< load [N.m]
  double output_angle{};              ///< relative to zero load [rad]
  double wave_generator_torque{};     ///< of the flexspline on the wave generator, about -torque over the ratio [N.m]
  double housing_torque{};            ///< of the housing on the flexspline, through its cup [N.m]
  double cup_rotation{};              ///< mean rotation of the teeth from rest [rad]
  int teeth_loaded{};                 ///< teeth that carry mesh force
  double mesh_force_max{};            ///< [N]
  double wave_generator_force_sum{};  ///< [N]
  std::vector<double> ball_force;     ///< of each ball of the bearing [N]; empty unless on single balls
  ToothStress stress;                 ///< of the flexspline
  ToothTable teeth;                   ///< every tooth
};
/// One row a torque, in their order; each is approached from no load, so that no row depends on another.
/// `wave_generator_angle`: any [rad]; `torques`: at the output, > 0 resists positive motion, any finite size [N.m].
/// Source: thesis 7.1 to 7.5; what a row says of a failed solve is `status`.
std::vector<StiffnessRow> analyseStiffness(const Parameters& parameters, double wave_generator_angle,
                                           const std::vector<double>& torques);

/// Quasi-static turning at constant load, friction left out.
struct TurnRow
{
  SolveStatus status;              ///< the numbers hold if ok()
  double wave_generator_angle{};   ///< [rad]
  double output_angle{};           ///< [rad]
  double kinematic_error{};        ///< of the output against the wave generator's angle over the nominal ratio [rad]
  double wave_generator_torque{};  ///< of the flexspline on the wave generator [N.m]
  double housing_torque{};         ///< of the housing on the flexspline, through its cup [N.m]
};
/// Rows 0 ... `steps` from angle 0 to `angle_range` [rad], steps >= 1; `load_torque` at the output [N.m]. `progress` is
/// called with each step done.
/// @throws InputError if steps < 1.
std::vector<TurnRow> analyseTurn(const Parameters& parameters, double load_torque, double angle_range, int steps,
                                 const std::function<void(int)>& progress);
}  // namespace hjt
