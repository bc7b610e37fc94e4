// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace hjt
{
class SurfacePool;

/// Source of a twin's response surfaces, with callbacks for progress and notices.
struct SurfaceSource
{
  std::string cache_directory;  ///< directory of stored surfaces, made if it is missing; empty: surfaces are not stored
  std::function<void(double)> progress{};  ///< called with the finished share of the build, 0 ... 1
  /// called with the reason why there is no surface, or why the surface was not stored
  std::function<void(const std::string&)> notice{};
  std::shared_ptr<SurfacePool> pool{};  ///< surfaces in memory, which the twin tries before the directory; may be null
  /// whether another thread builds the surface and calls `progress` and `notice`. The twin solves the full ring until
  /// the surface is built. The instant at which the twin changes to the surface depends on the computing time
  bool background{};
};

/// Directory of the cache: $XDG_CACHE_HOME/harmonic_joint_twin, else ~/.cache/harmonic_joint_twin; else empty.
std::string surfaceCacheDirectory();
}  // namespace hjt
