// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "surface/surface_cache.hpp"

namespace hjt
{
/// Whether the fault is one of the bearing's balls, races or cage. The positions of the balls repeat after other angles
/// than the gear, so a table over the two angles of the joint cannot contain such a fault.
bool isOfTheBalls(const Fault& fault) noexcept;

/// Response surface of the drive with `faults`; null if it has no surface. SurfaceSource::notice then gets the reason.
SurfacePool::Surface surfaceWithFaults(const Parameters& parameters, const FaultList& faults,
                                       const SurfaceSource& source);
}  // namespace hjt
