// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "studies/ring_stepper.hpp"

namespace hjt
{
/// The ways to march a dynamic ring.
enum class RingMethod
{
  RUNGE_KUTTA4,
  IMPLICIT_EULER,
  TR_BDF2,
  ESDIRK4
};

/// Has it an estimate of its error? Only then its steps can follow a tolerance.
bool judgesItsError(RingMethod method);

/// `force_tolerance`: out-of-balance force of an implicit stage [N], not below what the rounding of coordinates allows.
/// `tolerance` > 0, for methods that judge their error: largest error of a tooth's position by one step, the steps
/// being of its own choice [m]; 0: steps of the requested length.
std::unique_ptr<RingStepper> makeRingStepper(RingMethod method, DynamicRing& ring, const SolverParameters& solver,
                                             double tolerance = 0.0);
}  // namespace hjt
