// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace hjt
{
class SurfacePool;

/// Where a twin gets its response surfaces, and callbacks for progress.
struct SurfaceSource
{
  std::string cache_directory;  ///< directory of stored surfaces, made if missing; empty: surfaces are not stored
  std::function<void(double)> progress{};  ///< called with the built fraction, 0 ... 1
  /// called with the reason why there is no surface, or why it was not stored
  std::function<void(const std::string&)> notice{};
  std::shared_ptr<SurfacePool> pool{};  ///< surfaces in memory, searched before the cache; may be null
  /// If true, the twin solves the full ring until the surface is built. The instant of the change then depends on the
  /// computing time. Another thread calls `progress` and `notice`.
  bool background{};
};

/// $XDG_CACHE_HOME/harmonic_joint_twin or ~/.cache/harmonic_joint_twin; empty if there is no home directory.
std::string surfaceCacheDirectory();
}  // namespace hjt
