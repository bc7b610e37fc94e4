// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// State of the drive at one output angle, with the wave generator locked and without friction.
struct RatchetRow
{
  double output_angle{};              ///< angle of the output in the direction against the load; 0 without load [rad]
  double torque{};                    ///< load on the circular spline [N.m]
  double wave_amplitude{};            ///< amplitude of the wave [m]
  double lobe_force{};                ///< inward force of the ring on each lobe, minus this force without load [N]
  double depth_max{};                 ///< depth of the deepest tooth below the circular spline's tip circle [m]
  double mesh_force_max{};            ///< largest mesh force of a tooth [N]
  double wave_generator_force_max{};  ///< largest force of the wave generator on a tooth [N]
  int teeth_loaded{};                 ///< number of teeth that carry mesh force [-]
  int snaps{};                        ///< number of steps so far in which teeth snapped to a different equilibrium
  int teeth_jumped{};                 ///< number of teeth in contact in a different space than without load
};

enum class RatchetEnd
{
  LIMIT_REACHED,  ///< the torque reached the limit without a jump
  TEETH_JUMPED,   ///< the torque decreased, because teeth left their spaces
  NO_EQUILIBRIUM  ///< the ring has no equilibrium at the next angle; the peak is a lower bound of the jump torque
};

struct RatchetResult
{
  SolveStatus status;  ///< status of the solve without load
  RatchetEnd end{};
  RatchetRow peak;  ///< row of the largest torque; with TEETH_JUMPED the jump torque
  std::vector<RatchetRow> rows;
};

/// Computes the torque at which the teeth jump (ratcheting). The wave generator is locked, and the output moves in
/// steps of `angle_step` against the teeth until the torque decreases or reaches `torque_limit`.
///
/// `lobe_stiffness` k: radial stiffness of each lobe with its support [N/m], > 0, infinite for rigid lobes. With
/// elastic lobes the wave amplitude w is an unknown with the energy k (w_free - w)^2. The function chooses w_free such
/// that w is gear.wave_amplitude without load, because this amplitude is that of the assembled gear.
RatchetResult analyseRatchet(const Parameters& parameters, double wave_generator_angle, double lobe_stiffness,
                             double angle_step, double torque_limit, const std::function<void(double)>& progress);
}  // namespace hjt
