// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/work_precision/problem.hpp"

namespace hjt
{
/// One solver with one setting: a point of the diagram.
struct Contender
{
  std::string solver;
  std::string setting;
  /// `limit`: processor time after which it is given up [s].
  std::function<Run(const Problem& problem, double limit)> run;
};

/// The package's implicit methods at fixed steps, and Boost.odeint's explicit ones.
std::vector<Contender> ownContenders();
std::vector<Contender> odeintContenders(const Problem& problem);

/// CVODE, IDA and ARKODE with KLU, and with the package's structured linear solver.
std::vector<Contender> sundialsContenders();

/// Two methods that have nothing in common, at steps far below those compared.
std::vector<Contender> references(const Problem& problem);
}  // namespace hjt
