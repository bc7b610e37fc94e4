// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/solve_status.hpp"

#include <array>
#include <cstddef>

#include "base/number_text.hpp"

namespace hjt
{
namespace
{
const char* failureOf(SolveStage stage) noexcept
{
  constexpr std::array TEXTS{ "the insertion of the wave generator failed",
                              "the ring cannot be moved to the requested angles", "no output angle balances the load",
                              "the speeds after a step were not found" };
  return TEXTS[static_cast<std::size_t>(stage)];
}

/// Value of solver.max_iterations in config/solver.yaml, which is large enough for all shipped gears.
constexpr int SHIPPED_MAX_ITERATIONS = 20;

std::string adviceOf(const SolveStatus& status)
{
  if (status.code == SolveCode::NOT_FINITE)
  {
    return "a number overflowed. Look for extreme values among the parameters and angles";
  }
  if (status.max_iterations > 0 && status.max_iterations < SHIPPED_MAX_ITERATIONS)
  {
    return "raise solver.max_iterations from " + std::to_string(status.max_iterations) + " to the shipped " +
           std::to_string(SHIPPED_MAX_ITERATIONS);
  }
  if (status.stage == SolveStage::INSERTION || status.code == SolveCode::DISENGAGED)
  {
    return "the parts of the gear do not fit together. Compare gear.wave_amplitude, gear.rim_thickness, "
           "gear.tooth_height_flexspline, gear.tip_radius_circular_spline, mesh.flank_clearance and the numbers of "
           "teeth with those of a shipped gear";
  }
  if (status.stage == SolveStage::BALANCE)
  {
    return "the teeth do not carry the load. Reduce the load";
  }
  return status.code == SolveCode::ITERATION_LIMIT ?
             "take smaller steps of the angles, or raise solver.max_step_cuts" :
             "take smaller steps of the angles, or reduce the load, under which the teeth may be about to jump";
}
}  // namespace

const char* nameOf(SolveCode code) noexcept
{
  constexpr std::array NAMES{ "CONVERGED",  "ITERATION_LIMIT", "NO_DESCENT", "SINGULAR",
                              "NOT_FINITE", "UNBALANCED",      "DISENGAGED" };
  return NAMES[static_cast<std::size_t>(code)];
}

std::string explanationOf(const SolveStatus& status)
{
  TextStream text;
  if (status.ok())
  {
    return nameOf(status.code);
  }
  text << failureOf(status.stage) << " (" << nameOf(status.code) << ", ";
  if (status.code == SolveCode::DISENGAGED)
  {
    text << "no tooth touches a flank";
  }
  else if (status.stage == SolveStage::BALANCE)
  {
    text << "the teeth do not carry " << status.unbalanced_torque << " N.m of the load";
  }
  else
  {
    text << "largest out-of-balance force " << status.residual << " N";
  }
  text << "): " << adviceOf(status);
  return text.str();
}
}  // namespace hjt
