// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "apps/common/configuration.hpp"
#include "datasets/plan.hpp"

#include "surface/surface_cache.hpp"

namespace hjt
{
void addJobsOption(Command& command, unsigned& jobs);

/// Surfaces of the user's cache, each once in memory; each remark about them once.
/// Those of drives with a wear of their own, which come but once, are not kept on the disk.
SurfaceSource sharedSurfaces(const Plan& plan, unsigned jobs);
}  // namespace hjt
