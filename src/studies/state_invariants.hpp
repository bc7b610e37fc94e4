// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// How far one ring of teeth is from another that should be the same, turned and renumbered.
struct RingDifference
{
  double position{};       ///< largest distance of a tooth point from where it should be [m]
  double contact_force{};  ///< largest difference of the wave generator's force on a tooth [N]
  double flank_force{};    ///< largest difference of the force on a flank [N]
};

/// A state at rest under load, and the properties that hold in it for any parameters.
struct StateInvariants
{
  SolveStatus status;
  double load{};                   ///< on the circular spline [N.m]
  double wave_generator_angle{};   ///< [rad]
  double output_angle{};           ///< [rad]
  double energy{};                 ///< stored [J]
  double residual{};               ///< largest out-of-balance force on a tooth, of all states compared [N]
  double softest_stiffness{};      ///< smallest eigenvalue of the ring's tangent [N/m]
  double contact_force_max{};      ///< [N]
  double flank_force_max{};        ///< [N]
  RingDifference half_turn;        ///< tooth i + N/2 against tooth i, mirrored at the axis
  RingDifference pitch_shift;      ///< the ring solved some tooth pitches on, compared with this one renumbered
  double pitch_shift_energy{};     ///< difference of the stored energies, relative [-]
  double wave_generator_torque{};  ///< of the flexspline on the wave generator [N.m]
  double output_torque{};          ///< of the mesh on the circular spline [N.m]
  double cup_torque{};             ///< of the flexspline's cup on the housing [N.m]
};

/// Wave generator at `angle`, `load` on the circular spline; the shifted state `pitches` tooth pitches further on is
/// found by an insertion of its own, not from this one.
StateInvariants analyseState(const Parameters& parameters, double angle, double load, int pitches);

/// Torques against the differences of the stored energy of neighbouring equilibria, and the torques' own differences.
struct PotentialRow
{
  SolveStatus status;
  double wave_generator_step{};        ///< to either side [rad]
  double output_step{};                ///< the same, the joint's share of it [rad]
  double wave_generator_torque{};      ///< [N.m]
  double wave_generator_difference{};  ///< -dU/dtheta by central differences, less the torque [N.m]
  double output_torque{};              ///< [N.m]
  double output_difference{};          ///< -dU/dphi by central differences, less the torque [N.m]
  double wave_generator_by_output{};   ///< derivative of the wave generator's torque by the output angle [N.m/rad]
  double output_by_wave_generator{};   ///< derivative of the output's torque by the wave generator angle [N.m/rad]
  double condensed_stiffness{};        ///< minus either, from the ring's tangent [N.m/rad]
};

/// One row for each of `steps` [rad of the wave generator].
std::vector<PotentialRow> analysePotential(const Parameters& parameters, double angle, double load,
                                           const std::vector<double>& steps);
}  // namespace hjt
