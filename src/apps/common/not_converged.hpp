// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iostream>
#include <string>

#include "output/exit_code.hpp"

#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// Reports that no equilibrium was found for `what`, and why. @returns the exit code.
inline int notConverged(const std::string& what, const SolveStatus& status)
{
  std::cerr << "joint_twin: no equilibrium found for " << what << ": " << explanationOf(status) << '\n';
  return EXIT_FAILED;
}
}  // namespace hjt
