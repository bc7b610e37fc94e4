// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// The joint at one instant of a trial: [s], [rad], [N.m].
struct TrialSample
{
  double time{};
  double motor_angle{};
  double output_angle{};
  double wave_generator_torque{};
  double joint_torque{};
};

/// Course of a trial of the twin, and the twin's own messages.
struct TrialResult
{
  std::vector<TrialSample> samples;
  bool finite{ true };                   ///< every output of every step was a finite number
  SolverState state{ SolverState::OK };  ///< the worst
  TwinCounters counters;
  double iterations_mean{};  ///< Newton iterations a step [-]
  std::uint32_t iterations_max{};
  double residual_max{};             ///< largest out-of-balance force on a tooth [N]
  double energy_residual_max{};      ///< largest |energy in - stored - dissipated| [J]
  double throughput{};               ///< sum of |work| of motor and load [J]
  std::uint32_t substeps{};          ///< of a step
  double phase_advance_max{};        ///< largest, per substep [rad]
  double wave_generator_turn_max{};  ///< largest, per step [rad]
};

/// Marches the twin from where it stands to `end`, `feed` giving the inputs of every step before it (false: stop), and
/// looks at every step; keeps a sample every `sample_period` [ns], which should be a multiple of the step. Stops at the
/// first step that is not finite.
TrialResult runTrial(Twin& twin, Stamp end, Stamp sample_period, const std::function<bool(Twin&)>& feed);
}  // namespace hjt
