// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// How a solve ended.
enum class SolveCode
{
  CONVERGED,        ///< out-of-balance forces are within solver.force_tolerance
  ITERATION_LIMIT,  ///< solver.max_iterations was reached, even after solver.max_step_cuts halvings of the move
  NO_DESCENT,       ///< no step reduced the out-of-balance forces, even after solver.max_step_cuts halvings
  SINGULAR,         ///< the tangent matrix has no inverse
  NOT_FINITE,       ///< a value became NaN or infinite
  UNBALANCED,       ///< no output angle that the search reaches balances the load
  DISENGAGED        ///< no tooth touches a flank at any output angle that the search reaches
};

/// Task of the solver.
enum class SolveStage
{
  INSERTION,  ///< insertion of the wave generator
  MOTION,     ///< motion of wave generator and output to given angles
  BALANCE,    ///< search for the output angle at which the gear balances the load
  FRICTION    ///< solution for the speeds after a step under dry friction
};

/// Outcome of a solve, which the caller must check.
struct [[nodiscard]] SolveStatus
{
  SolveCode code{ SolveCode::CONVERGED };  ///< how the solve ended
  SolveStage stage{ SolveStage::MOTION };  ///< task in which the solve ended
  int iterations{};                        ///< number of Newton iterations in all attempts at this solve
  int cuts{};                              ///< number of times that the solver halved the move
  int max_iterations{};                    ///< solver.max_iterations if the last attempt reached this limit; else 0
  int jumps{};        ///< number of teeth that passed over a tip into another space, by ratcheting or in one long move
  double residual{};  ///< largest out-of-balance force component on a tooth [N]
  double unbalanced_torque{};  ///< part of the load at the output that the mesh did not balance [N.m]

  bool ok() const noexcept { return code == SolveCode::CONVERGED; }  ///< whether the solve converged

  /// Adds the iterations and cuts of an earlier attempt to those of this status.
  SolveStatus& addEffort(const SolveStatus& before) noexcept
  {
    iterations += before.iterations;
    cuts += before.cuts;
    return *this;
  }
};

/// Name of the code as in the source, for example "NO_DESCENT".
const char* nameOf(SolveCode code) noexcept;

/// Message for the user: the stage that failed, the code, the largest force or the torque out of balance, and advice.
std::string explanationOf(const SolveStatus& status);
}  // namespace hjt
