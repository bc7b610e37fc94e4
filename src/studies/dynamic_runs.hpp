// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
/// Insertion of the wave generator as motion (thesis ch. 6): the wave's amplitude grows at constant speed from 0 to w0,
/// then stays; circular spline left out, wave generator held.
struct TransientSetup
{
  RingMethod method{ RingMethod::ESDIRK4 };
  double step{ 5e-6 };           ///< [s]
  double duration{ 0.05 };       ///< [s]
  double growth_time{ 5e-3 };    ///< in which the amplitude grows [s]
  double window_start{ 0.03 };   ///< from here to the end the largest force is summed up [s]
  double sample_period{ 5e-5 };  ///< of the rows [s]
  double tolerance{};  ///< of a tooth's position by one step, which is then at most `step`; 0: every step is it [m]
};

/// Largest force of the wave generator on a tooth, and where the energy is.
struct TransientRow
{
  double time{};          ///< [s]
  double force_max{};     ///< on any tooth at this instant [N]
  double force_lowest{};  ///< of it since the row before [N]
  double force_highest{};
  double radius_major_axis{};  ///< of tooth 0 [m]
  double stored{};             ///< since the start [J]
  double kinetic{};            ///< [J]
  double supplied{};           ///< by the wave generator's growth [J]
  double dissipated{};         ///< by the dashpots [J]
};

struct TransientResult
{
  bool finished{};
  double stopped_at{};  ///< [s]
  std::vector<TransientRow> rows;
  double window_lowest{};   ///< of the largest force, over all steps of the window [N]
  double window_highest{};  ///< [N]
  double window_mean{};     ///< [N]
  StepCounts counts;
  double solve_time{};          ///< [s]
  std::vector<double> tooth_x;  ///< at the end, per tooth [m]
  std::vector<double> tooth_y;
};

/// `progress` is called with the part done, 0 ... 1.
TransientResult analyseTransient(const Parameters& parameters, const TransientSetup& setup,
                                 const std::function<void(double)>& progress);

/// The working drive with a dynamic ring, compared with the ring in equilibrium: the wave generator turns at a constant
/// speed, the circular spline is a free body under a constant load. Dry friction is left out on both sides.
///
/// It starts from the travelling equilibrium: positions and speeds of the ring that follows the wave generator in
/// equilibrium. What is left of a start transient is given `settle_time` to die out.
struct QuasiStaticSetup
{
  RingMethod method{ RingMethod::TR_BDF2 };
  double speed{ 317.0 };           ///< of the wave generator [rad/s]
  double load{ 20.0 };             ///< on the circular spline [N.m]
  double step{ 2e-6 };             ///< [s]
  double settle_time{ 5e-3 };      ///< not compared [s]
  double duration{ 5e-3 };         ///< compared [s]
  double compare_period{ 37e-6 };  ///< between two comparisons [s]
  double tolerance{};  ///< of a tooth's position by one step, which is then at most `step`; 0: every step is it [m]
};

/// Difference of a quantity from its quasi-static value.
struct DynamicError
{
  double size{};  ///< root mean square of the quasi-static quantity: what errors are relative to
  double rms{};
  double max{};
};

/// One comparison, the last: force per tooth on both sides.
struct ToothForceComparison
{
  double time{};                             ///< [s]
  std::vector<double> contact_dynamic;       ///< [N]
  std::vector<double> contact_quasi_static;  ///< [N]
  std::vector<double> mesh_dynamic;          ///< [N]
  std::vector<double> mesh_quasi_static;     ///< [N]
};

struct QuasiStaticRow
{
  double time{};                           ///< [s]
  double torsion_dynamic{};                ///< output angle less wave generator angle over the ratio [rad]
  double torsion_quasi_static{};           ///< of the equilibrium that balances the load at the same angle [rad]
  double wave_generator_torque_dynamic{};  ///< [N.m]
  double wave_generator_torque_quasi_static{};
  double contact_error_rms{};  ///< over the teeth [N]
  double mesh_error_rms{};     ///< over the teeth [N]
};

enum class QuasiStaticOutcome
{
  DONE,
  STEP_FAILED,
  NO_EQUILIBRIUM
};

/// Forces, torques and positions are compared with the ring in equilibrium at the same two angles, which is what the
/// twin computes; the torsion with that of the equilibrium under the same load.
struct QuasiStaticResult
{
  QuasiStaticOutcome outcome{ QuasiStaticOutcome::NO_EQUILIBRIUM };
  SolveStatus status;                  ///< of the last equilibrium that was sought
  double stopped_at{};                 ///< [s]
  DynamicError contact_force;          ///< per tooth [N]
  DynamicError mesh_force;             ///< per tooth; size over the loaded ones [N]
  DynamicError position;               ///< per tooth point; size: the displacement from rest [m]
  DynamicError wave_generator_torque;  ///< [N.m]
  DynamicError output_torque;          ///< [N.m]
  DynamicError torsion;                ///< [rad]
  long force_evaluations{};
  double solve_time{};  ///< of the dynamic ring [s]
  std::vector<QuasiStaticRow> rows;
  ToothForceComparison last;
};

/// `progress` is called with the part done, 0 ... 1.
QuasiStaticResult checkQuasiStatic(const Parameters& parameters, const QuasiStaticSetup& setup,
                                   const std::function<void(double)>& progress);
}  // namespace hjt
