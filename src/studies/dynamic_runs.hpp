// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
/// Insertion of the wave generator as a motion (thesis ch. 6): the amplitude of the wave grows at constant speed from 0
/// to gear.wave_amplitude and then stays constant. The ring has no circular spline. The wave generator does not turn.
struct TransientSetup
{
  RingMethod method{ RingMethod::ESDIRK4 };
  double step{ 5e-6 };           ///< length of a step [s]
  double duration{ 0.05 };       ///< length of the run [s]
  double growth_time{ 5e-3 };    ///< time in which the amplitude grows [s]
  double window_start{ 0.03 };   ///< start of the window of the statistics; the window ends with the run [s]
  double sample_period{ 5e-5 };  ///< time between two rows [s]
  /// largest error of a tooth's position in one step [m]. With a value > 0 the length of the steps varies up to `step`.
  /// With 0 all steps have the length `step`.
  double tolerance{};
};

/// Largest force of the wave generator on a tooth and energies of the ring, at one instant.
struct TransientRow
{
  double time{};               ///< [s]
  double force_max{};          ///< largest force on a tooth at this instant [N]
  double force_lowest{};       ///< least value of force_max since the preceding row [N]
  double force_highest{};      ///< largest value of force_max since the preceding row [N]
  double radius_major_axis{};  ///< radius of tooth 0, at the major axis [m]
  double stored{};             ///< increase of the stored energy since the start [J]
  double kinetic{};            ///< kinetic energy [J]
  double supplied{};           ///< energy supplied by the growth of the wave generator [J]
  double dissipated{};         ///< energy dissipated by the dashpots [J]
};

struct TransientResult
{
  bool finished{};      ///< whether the run reached its end
  double stopped_at{};  ///< time at which the integration failed [s]
  std::vector<TransientRow> rows;
  double window_lowest{};   ///< least value of TransientRow::force_max over all steps of the window [N]
  double window_highest{};  ///< largest value of force_max over all steps of the window [N]
  double window_mean{};     ///< mean of force_max over the window [N]
  StepCounts counts;
  double solve_time{};          ///< computing time [s]
  std::vector<double> tooth_x;  ///< x of each tooth point at the end [m]
  std::vector<double> tooth_y;  ///< y of each tooth point at the end [m]
};

/// Simulates the insertion. The function calls `progress` with the finished fraction of the run, 0 ... 1.
TransientResult analyseTransient(const Parameters& parameters, const TransientSetup& setup,
                                 const std::function<void(double)>& progress);

/// Comparison of a dynamic ring at work with the ring in equilibrium. The wave generator turns at a constant speed, and
/// the circular spline is a free body under a constant load. Both rings are without dry friction.
///
/// The run starts with the positions and speeds of the ring in equilibrium (travelInEquilibrium). The transient that
/// follows the start decays in `settle_time`.
struct QuasiStaticSetup
{
  RingMethod method{ RingMethod::TR_BDF2 };
  double speed{ 317.0 };           ///< speed of the wave generator [rad/s]
  double load{ 20.0 };             ///< load on the circular spline [N.m]
  double step{ 2e-6 };             ///< length of a step [s]
  double settle_time{ 5e-3 };      ///< time before the first comparison [s]
  double duration{ 5e-3 };         ///< duration of the comparison [s]
  double compare_period{ 37e-6 };  ///< time between two comparisons [s]
  /// largest error of a tooth's position in one step [m]. With a value > 0 the length of the steps varies up to `step`.
  /// With 0 all steps have the length `step`.
  double tolerance{};
};

/// Difference of a quantity between the dynamic ring and the ring in equilibrium.
struct DynamicError
{
  double size{};  ///< root mean square of the quantity in equilibrium, to which relative errors refer
  double rms{};   ///< root mean square of the difference
  double max{};   ///< largest magnitude of the difference
};

/// Forces on each tooth in the last comparison, for the dynamic ring and the ring in equilibrium.
struct ToothForceComparison
{
  double time{};                             ///< [s]
  std::vector<double> contact_dynamic;       ///< force of the wave generator, dynamic ring [N]
  std::vector<double> contact_quasi_static;  ///< force of the wave generator, ring in equilibrium [N]
  std::vector<double> mesh_dynamic;          ///< mesh force, dynamic ring [N]
  std::vector<double> mesh_quasi_static;     ///< mesh force, ring in equilibrium [N]
};

struct QuasiStaticRow
{
  double time{};                           ///< [s]
  double torsion_dynamic{};                ///< output angle - wave generator angle / ratio, dynamic ring [rad]
  double torsion_quasi_static{};           ///< this torsion in equilibrium under the load at the same motor angle [rad]
  double wave_generator_torque_dynamic{};  ///< torque on the wave generator, dynamic ring [N.m]
  double wave_generator_torque_quasi_static{};  ///< torque on the wave generator, ring in equilibrium [N.m]
  double contact_error_rms{};  ///< wave generator's force on a tooth: rms of dynamic - equilibrium over the teeth [N]
  double mesh_error_rms{};     ///< mesh force on a tooth: rms of dynamic - equilibrium over the loaded teeth [N]
};

enum class QuasiStaticOutcome
{
  DONE,
  STEP_FAILED,
  NO_EQUILIBRIUM
};

/// Differences between the dynamic ring and equilibria. Forces, torques and positions are compared with the equilibrium
/// at the two angles of the dynamic ring, as in the twin. The torsion is compared with the equilibrium under the load.
struct QuasiStaticResult
{
  QuasiStaticOutcome outcome{ QuasiStaticOutcome::NO_EQUILIBRIUM };
  SolveStatus status;                  ///< status of the last equilibrium
  double stopped_at{};                 ///< time at which the integration or an equilibrium failed [s]
  DynamicError contact_force;          ///< force of the wave generator on each tooth [N]
  DynamicError mesh_force;             ///< mesh force of each tooth; `size` and `rms` over the loaded teeth [N]
  DynamicError position;               ///< position of each tooth point; `size` is the displacement from rest [m]
  DynamicError wave_generator_torque;  ///< [N.m]
  DynamicError output_torque;          ///< [N.m]
  DynamicError torsion;                ///< [rad]
  long force_evaluations{};
  double solve_time{};  ///< computing time of the dynamic ring [s]
  std::vector<QuasiStaticRow> rows;
  ToothForceComparison last;
};

/// Runs the comparison. The function calls `progress` with the finished fraction of the run, 0 ... 1.
QuasiStaticResult checkQuasiStatic(const Parameters& parameters, const QuasiStaticSetup& setup,
                                   const std::function<void(double)>& progress);
}  // namespace hjt
