// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <ros/console.h>

#include "harmonic_joint_twin/surface/surface_source.hpp"

namespace hjt
{
/// The user's cache of response surfaces, with progress and notices in the node's log. `background`: see SurfaceSource.
inline SurfaceSource nodeSurfaceSource(bool background)
{
  return { surfaceCacheDirectory(),
           [](double done) { ROS_INFO_THROTTLE(2.0, "building the response surface: %.0f %%", 100.0 * done); },
           [](const std::string& what) { ROS_WARN_STREAM(what); },
           {},
           background };
}
}  // namespace hjt
