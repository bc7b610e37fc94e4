// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace hjt
{
class SurfacePool;

/// Where a twin takes response surfaces from, and callbacks for progress.
struct SurfaceSource
{
  std::string cache_directory;                       ///< made if missing; empty: nothing is kept
  std::function<void(double)> progress{};            ///< of building, 0 ... 1
  std::function<void(const std::string&)> notice{};  ///< why there is no surface, or why it could not be kept
  std::shared_ptr<SurfacePool> pool{};               ///< asked before the cache; may be none
  /// The twin does not wait for it but solves the full ring until it is there. From when on the surface is used then
  /// depends on how long that takes. `progress` and `notice` are called from another thread.
  bool background{};
};

/// $XDG_CACHE_HOME/harmonic_joint_twin, or ~/.cache/harmonic_joint_twin; empty if there is no home.
std::string surfaceCacheDirectory();
}  // namespace hjt
