// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "harmonic_joint_twin/surface/surface_source.hpp"

namespace hjt
{
/// How the caller of a long function follows and ends it. What a function of these throws ends it at once.
struct Watch
{
  /// A step of this name begins; gives the function that is told how far it is, 0 ... 1.
  std::function<std::function<void(double)>(const std::string&)> progress{ [](const std::string&)
                                                                           { return [](double) {}; } };
  /// Asked at every row and between the steps; true: the rest is left out and files are closed.
  std::function<bool()> stopped{ [] { return false; } };
  /// A remark for the user, in a sentence without a full stop.
  std::function<void(const std::string&)> notice{ [](const std::string&) {} };
};

/// The caller stopped a step that has no result.
struct Stopped
{
};

/// Response surfaces from the user's cache. Building throws `Stopped`.
inline SurfaceSource surfaceSource(const Watch& watch)
{
  const auto show = [update = watch.progress("building the response surface"), stopped = watch.stopped](double done)
  {
    update(done);
    if (stopped())
    {
      throw Stopped{};
    }
  };
  return { surfaceCacheDirectory(), show, watch.notice };
}
}  // namespace hjt
