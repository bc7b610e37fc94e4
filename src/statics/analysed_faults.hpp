// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// How much of the joint an analysis has.
enum class Analysis
{
  INSERTION,     ///< the ring on the wave generator, without circular spline and friction
  RING,          ///< the whole ring without friction
  WITH_FRICTION  ///< all of the joint
};

/// An analysis has the faults that the joint starts with, and no time for others to set in.
/// @throws ParameterError for a configured fault that cannot act in it.
void requireFaultsAct(const Parameters& parameters, Analysis analysis);
}  // namespace hjt
