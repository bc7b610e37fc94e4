// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "surface/surface_cache.hpp"

namespace hjt
{
/// Of the wave generator's bearing: a table over the angles of motor and output does not contain them.
bool isOfTheBalls(const Fault& fault) noexcept;

/// The response surface of the drive with these faults; if there is none, the source gets the reason.
SurfacePool::Surface surfaceWithFaults(const Parameters& parameters, const FaultList& faults,
                                       const SurfaceSource& source);
}  // namespace hjt
