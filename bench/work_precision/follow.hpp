// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/work_precision/problem.hpp"

namespace hjt
{
/// A solver on its way through a problem.
class Integrator
{
public:
  virtual ~Integrator() = default;

  /// The right-hand side changes to that of a phase which begins at a time.
  virtual void enter(const Phase& phase, double time) = 0;

  /// Goes on from `time`, at least by one step of its own, at most to the phase's end; one that cannot tell the state
  /// within a step ends at `due` and no later. False if it fails. Pairs teeth and spaces after every step.
  virtual bool advance(double due, double end, double& time) = 0;

  /// State at a time within the last step.
  virtual const double* at(double time) = 0;

  /// Fills in what it has counted.
  virtual void count(Run& run) = 0;
};

/// Leads a solver through the phases and samples of a problem; time before and after, such as that of a solver's
/// construction, is not counted.
Run follow(const Problem& problem, Integrator& integrator, double limit);

/// A number in a text, for settings and failures.
std::string text(const char* format, double value);
}  // namespace hjt
