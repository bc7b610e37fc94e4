// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "surface/surface_cache.hpp"

namespace hjt
{
/// Whether the fault is one of the bearing's balls and races, which a table over motor and output angle does not
/// contain.
bool isOfTheBalls(const Fault& fault) noexcept;

/// Response surface of the drive with these faults. If there is none, the source's `notice` gets the reason.
SurfacePool::Surface surfaceWithFaults(const Parameters& parameters, const FaultList& faults,
                                       const SurfaceSource& source);
}  // namespace hjt
