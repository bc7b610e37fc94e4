// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "harmonic_joint_twin/solver/ring_stepper.hpp"

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

/// `force_tolerance`: out-of-balance force of an implicit stage [N], not below what the rounding of coordinates allows.
std::unique_ptr<RingStepper> makeRingStepper(RingMethod method, DynamicRing& ring, const SolverParameters& solver);
}  // namespace hjt
