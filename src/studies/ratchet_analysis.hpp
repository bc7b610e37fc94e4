// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// One output angle of the locked drive, friction left out.
struct RatchetRow
{
  double output_angle{};              ///< against the loaded torque, from no load [rad]
  double torque{};                    ///< load on the circular spline [N.m]
  double wave_amplitude{};            ///< [m]
  double lobe_force{};                ///< with which the ring presses each lobe in, beyond no load [N]
  double depth_max{};                 ///< of the deepest tooth below the circular spline's tip circle [m]
  double mesh_force_max{};            ///< [N]
  double wave_generator_force_max{};  ///< [N]
  int teeth_loaded{};                 ///< [-]
  int snaps{};                        ///< steps so far whose next equilibrium was found by energy descent only [-]
  int teeth_jumped{};                 ///< teeth in contact in another space than at no load [-]
};

enum class RatchetEnd
{
  LIMIT_REACHED,  ///< the torque limit: no jump up to there
  TEETH_JUMPED,   ///< the torque fell as teeth left their spaces
  NO_EQUILIBRIUM  ///< gave up: the ring found none at the next angle; the peak is a lower bound of the jump
};

struct RatchetResult
{
  SolveStatus status;  ///< at no load
  RatchetEnd end{};
  RatchetRow peak;  ///< of the largest torque: the jump, if the teeth jumped
  std::vector<RatchetRow> rows;
};

/// Jump of the teeth (ratcheting): wave generator locked, the output driven step by step against the teeth until the
/// torque falls. Displacement controlled, so that the fall is followed as far as there is an equilibrium.
///
/// `lobe_stiffness` k: radial stiffness of each of the two lobes with all that backs it up [N/m], > 0, infinite for
/// rigid. The wave amplitude w is then one more unknown with the energy k (w_free - w)^2, w_free such that w = w0 at no
/// load: w0 is what was measured on the assembled gear.
RatchetResult analyseRatchet(const Parameters& parameters, double wave_generator_angle, double lobe_stiffness,
                             double angle_step, double torque_limit, const std::function<void(double)>& progress);
}  // namespace hjt
