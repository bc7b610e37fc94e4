// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iostream>
#include <string>

#include "apps/common/exit_code.hpp"
#include "apps/common/text_table.hpp"

namespace hjt
{
/// Says that no equilibrium was found for `what`; `residual` [N]. Gives the exit code.
inline int notConverged(const std::string& what, double residual)
{
  std::cerr << "joint_twin: no equilibrium found for " << what << " (largest out-of-balance force "
            << shortNumber(residual) << " N); see solver.max_iterations and solver.max_step_cuts\n";
  return EXIT_FAILED;
}
}  // namespace hjt
