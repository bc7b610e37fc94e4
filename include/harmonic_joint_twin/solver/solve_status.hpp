// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// How a solve ended.
enum class SolveCode
{
  CONVERGED,        ///< within solver.force_tolerance
  ITERATION_LIMIT,  ///< solver.max_iterations ran out, on the shortest path too
  NO_DESCENT,       ///< no step reduced the forces, on the shortest path neither
  SINGULAR,         ///< the tangent has no inverse
  NOT_FINITE,       ///< NaN or Inf came up
  UNBALANCED,       ///< no output angle within reach balances the load
  DISENGAGED        ///< no tooth touches, at any output angle within reach
};

/// Task of the solver.
enum class SolveStage
{
  INSERTION,  ///< of the wave generator
  MOTION,     ///< to given angles of wave generator and output
  BALANCE,    ///< of the load, by turning the output
  FRICTION    ///< in a step of the joint: speeds at which it balances the other torques
};

/// Outcome of a solve; the caller must look.
struct [[nodiscard]] SolveStatus
{
  SolveCode code{ SolveCode::CONVERGED };  ///< how it ended
  SolveStage stage{ SolveStage::MOTION };  ///< task that ended so
  int iterations{};                        ///< Newton iterations, all attempts
  int cuts{};                              ///< halvings of the path
  int max_iterations{};                    ///< solver.max_iterations, if the last attempt ran out of them; else 0
  int jumps{};                 ///< teeth that changed their space through a tip: ratcheting, or too long a move
  double residual{};           ///< largest out-of-balance force component on a tooth [N]
  double unbalanced_torque{};  ///< part of the load that the mesh did not carry in the last balance [N.m]

  bool ok() const noexcept { return code == SolveCode::CONVERGED; }  ///< it converged

  /// Adds the effort of an earlier attempt.
  SolveStatus& addEffort(const SolveStatus& before) noexcept
  {
    iterations += before.iterations;
    cuts += before.cuts;
    return *this;
  }
};

/// Name of the status as in the source, e.g. "NO_DESCENT".
const char* nameOf(SolveCode code) noexcept;

/// Message for the user: the stage that failed, the code, what was left unbalanced and what to do.
std::string explanationOf(const SolveStatus& status);
}  // namespace hjt
