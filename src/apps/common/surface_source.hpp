// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/surface/surface_source.hpp"

namespace hjt
{
/// Response surfaces from the user's cache; building shows its progress and what is amiss on stderr.
SurfaceSource surfaceSource();
}  // namespace hjt
