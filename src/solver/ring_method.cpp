// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/ring_method.hpp"

#include "harmonic_joint_twin/solver/explicit_ring_stepper.hpp"
#include "harmonic_joint_twin/solver/implicit_ring_stepper.hpp"

namespace hjt
{
std::unique_ptr<RingStepper> makeRingStepper(RingMethod method, DynamicRing& ring, const SolverParameters& solver)
{
  switch (method)
  {
    case RingMethod::RUNGE_KUTTA4:
      return std::make_unique<ExplicitRingStepper>(ring);
    case RingMethod::IMPLICIT_EULER:
      return std::make_unique<ImplicitRingStepper>(ring, implicitEuler(), solver);
    case RingMethod::TR_BDF2:
      return std::make_unique<ImplicitRingStepper>(ring, trBdf2(), solver);
    case RingMethod::ESDIRK4:
      return std::make_unique<ImplicitRingStepper>(ring, esdirk4(), solver);
  }
  return nullptr;
}
}  // namespace hjt
