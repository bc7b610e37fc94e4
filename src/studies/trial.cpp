// SPDX-License-Identifier: BSD-3-Clause
#include "studies/trial.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
bool allFinite(const JointOutputs& o) noexcept
{
  for (const double value : { o.motor_angle, o.motor_velocity, o.output_angle, o.output_velocity, o.motor_torque,
                              o.load_torque, o.wave_generator_torque, o.joint_torque, o.friction_torque,
                              o.torsional_stiffness, o.energy_residual, o.residual })
  {
    if (!std::isfinite(value))
    {
      return false;
    }
  }
  return true;
}
}  // namespace

TrialResult runTrial(Twin& twin, Stamp end, Stamp sample_period, const std::function<bool(Twin&)>& feed)
{
  TrialResult result;
  const Stamp begin = twin.stamp();
  double iterations = 0.0;
  JointOutputs last = twin.outputs();
  while (result.finite && feed(twin) && twin.step(end))
  {
    const JointOutputs& now = twin.outputs();
    result.finite = allFinite(now);
    iterations += now.iterations;
    result.iterations_max = std::max(result.iterations_max, now.iterations);
    result.residual_max = std::max(result.residual_max, now.residual);
    result.energy_residual_max = std::max(result.energy_residual_max, std::abs(now.energy_residual));
    result.substeps = now.substeps;
    result.phase_advance_max = std::max(result.phase_advance_max, now.phase_advance);
    const double turn = now.motor_angle - last.motor_angle;
    result.wave_generator_turn_max = std::max(result.wave_generator_turn_max, std::abs(turn));
    result.throughput +=
        std::abs(now.motor_torque * turn) + std::abs(now.load_torque * (now.output_angle - last.output_angle));
    if ((now.stamp - begin) % sample_period == 0)
    {
      result.samples.push_back({ 1e-9 * static_cast<double>(now.stamp - begin), now.motor_angle, now.output_angle,
                                 now.wave_generator_torque, now.joint_torque });
    }
    last = now;
  }
  result.counters = twin.counters();
  result.state = twin.health().solver_state;
  result.iterations_mean = iterations / std::max<double>(1.0, static_cast<double>(result.counters.steps));
  return result;
}
}  // namespace hjt
