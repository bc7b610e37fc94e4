// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace hjt
{
/// Coefficients of a diagonally implicit Runge-Kutta method, stiffly accurate: the last stage is the step's end.
///
/// All implicit stages share the diagonal gamma, so one factored matrix serves them all. The first stage may be
/// explicit.
struct RungeKuttaTableau
{
  int order;
  double gamma;                             ///< diagonal of the implicit stages [-]
  bool explicit_first;                      ///< the first stage is the step's start
  std::vector<std::vector<double>> before;  ///< row per stage: weights of the stages before it [-]
  std::vector<double> times;                ///< of the stages, in steps [-]
  std::vector<double> error;                ///< weights of the embedded error estimate; empty: none [-]
  int error_power;                          ///< of the step that the estimate goes with; 0: none

  int stages() const { return static_cast<int>(times.size()); }
  /// Weight of stage i in the step: the last row.
  double weight(int i) const { return i + 1 == stages() ? gamma : before.back()[static_cast<std::size_t>(i)]; }
};

/// Order 1, L-stable: what ode14x of the thesis' chapter 6 extrapolates from.
const RungeKuttaTableau& implicitEuler();

/// Order 2, L-stable, stage order 2: trapezoidal rule and BDF2 as one method (Bank et al. 1985; embedded estimate of
/// order 3 of Hosea and Shampine 1996).
const RungeKuttaTableau& trBdf2();

/// Order 4, L-stable, stage order 2, six stages, embedded order 3 (Kennedy and Carpenter 2003, ARK4(3)6L[2]SA, implicit
/// part).
const RungeKuttaTableau& esdirk4();
}  // namespace hjt
