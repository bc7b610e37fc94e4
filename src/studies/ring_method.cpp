// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ring_method.hpp"

#include "studies/adaptive_ring_stepper.hpp"
#include "studies/explicit_ring_stepper.hpp"

namespace hjt
{
namespace
{
const RungeKuttaTableau& tableauOf(RingMethod method)
{
  return method == RingMethod::TR_BDF2 ? trBdf2() : method == RingMethod::ESDIRK4 ? esdirk4() : implicitEuler();
}
}  // namespace

bool judgesItsError(RingMethod method)
{
  return method == RingMethod::TR_BDF2 || method == RingMethod::ESDIRK4;
}

std::unique_ptr<RingStepper> makeRingStepper(RingMethod method, DynamicRing& ring, const SolverParameters& solver,
                                             double tolerance)
{
  if (method == RingMethod::RUNGE_KUTTA4)
  {
    return std::make_unique<ExplicitRingStepper>(ring);
  }
  if (judgesItsError(method) && tolerance > 0.0)
  {
    return std::make_unique<AdaptiveRingStepper>(ring, tableauOf(method), solver, tolerance);
  }
  return std::make_unique<ImplicitRingStepper>(ring, tableauOf(method), solver);
}
}  // namespace hjt
