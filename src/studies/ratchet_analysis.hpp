// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// One output angle of the drive with locked wave generator, without friction.
struct RatchetRow
{
  double output_angle{};              ///< angle against the load's torque, from no load [rad]
  double torque{};                    ///< load on the circular spline [N.m]
  double wave_amplitude{};            ///< amplitude of the wave [m]
  double lobe_force{};                ///< inward force of the ring on each lobe, minus that without load [N]
  double depth_max{};                 ///< depth of the deepest tooth below the circular spline's tip circle [m]
  double mesh_force_max{};            ///< largest mesh force of a tooth [N]
  double wave_generator_force_max{};  ///< largest force of the wave generator on a tooth [N]
  int teeth_loaded{};                 ///< number of teeth that carry mesh force [-]
  int snaps{};                        ///< number of steps so far that needed energy descent [-]
  int teeth_jumped{};                 ///< number of teeth in contact in another space than without load [-]
};

enum class RatchetEnd
{
  LIMIT_REACHED,  ///< the torque reached the limit without a jump
  TEETH_JUMPED,   ///< the torque decreased as teeth left their spaces
  NO_EQUILIBRIUM  ///< the ring has no equilibrium at the next angle; the peak is a lower bound of the jump torque
};

struct RatchetResult
{
  SolveStatus status;  ///< status of the solve without load
  RatchetEnd end{};
  RatchetRow peak;  ///< row of the largest torque, at which the teeth jumped if they did
  std::vector<RatchetRow> rows;
};

/// Jump of the teeth (ratcheting). The wave generator is locked, and the output moves in steps against the teeth until
/// the torque decreases. Displacement control follows the decrease as long as there is an equilibrium.
///
/// `lobe_stiffness` k: radial stiffness of each lobe with its support [N/m], > 0, infinite for rigid lobes. The wave
/// amplitude w is then an unknown with the energy k (w_free - w)^2. w_free is such that w = w0 without load, because w0
/// was measured on the assembled gear.
RatchetResult analyseRatchet(const Parameters& parameters, double wave_generator_angle, double lobe_stiffness,
                             double angle_step, double torque_limit, const std::function<void(double)>& progress);
}  // namespace hjt
