// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/work_precision/problem.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
/// One solver with one setting on one problem, which must outlive it: a point of the diagram.
struct Contender
{
  std::string solver;
  std::string setting;
  /// `limit`: processor time after which it is given up [s].
  std::function<Run(double limit)> run;
};

/// What explicit methods are given of a run's limit: their steps are many whatever the error.
constexpr double EXPLICIT_PATIENCE = 2.0;

/// A method of the package at a fixed step [s].
Contender fixedStep(const Problem& problem, const std::string& solver, RingMethod method, double step,
                    double force_tolerance);

/// The package's methods over their tolerances, and the thesis' way: implicit Euler at 10 us.
std::vector<Contender> ownContenders(const Problem& problem);

/// Boost.odeint's explicit methods.
std::vector<Contender> odeintContenders(const Problem& problem);

/// CVODE, IDA and ARKODE with KLU.
std::vector<Contender> sundialsContenders(const Problem& problem);

/// RADAU5 out of R's deSolve; none where that is not installed.
std::vector<Contender> radauContenders(const Problem& problem);

/// Two methods that have nothing in common, at steps far below those compared.
std::vector<Contender> references(const Problem& problem);
}  // namespace hjt
