// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ring_method.hpp"

#include "studies/adaptive_ring_stepper.hpp"
#include "studies/dormand_prince_stepper.hpp"
#include "studies/explicit_ring_stepper.hpp"
#include "studies/implicit_ring_stepper.hpp"

namespace hjt
{
namespace
{
std::unique_ptr<EmbeddedRingStepper> makeEmbedded(RingMethod method, DynamicRing& ring, const SolverParameters& solver)
{
  switch (method)
  {
    case RingMethod::DORMAND_PRINCE8:
      return std::make_unique<DormandPrinceStepper>(ring);
    case RingMethod::TR_BDF2:
      return std::make_unique<ImplicitRingStepper>(ring, trBdf2(), solver);
    case RingMethod::ESDIRK4:
      return std::make_unique<ImplicitRingStepper>(ring, esdirk4(), solver);
    case RingMethod::IMPLICIT_EULER:
      return std::make_unique<ImplicitRingStepper>(ring, implicitEuler(), solver);
    case RingMethod::RUNGE_KUTTA4:
      break;
  }
  return nullptr;
}
}  // namespace

bool judgesItsError(RingMethod method)
{
  return method != RingMethod::RUNGE_KUTTA4 && method != RingMethod::IMPLICIT_EULER;
}

std::unique_ptr<RingStepper> makeRingStepper(RingMethod method, DynamicRing& ring, const SolverParameters& solver,
                                             double tolerance)
{
  if (judgesItsError(method) && tolerance > 0.0)
  {
    return std::make_unique<AdaptiveRingStepper>(ring, makeEmbedded(method, ring, solver), tolerance);
  }
  if (method == RingMethod::RUNGE_KUTTA4)
  {
    return std::make_unique<ExplicitRingStepper>(ring);
  }
  return makeEmbedded(method, ring, solver);
}
}  // namespace hjt
