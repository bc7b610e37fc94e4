// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "harmonic_joint_twin/surface/surface_source.hpp"

namespace hjt
{
/// Prints the progress of a long step to stderr: a bar on a terminal, else a line every few seconds; nothing if it is
/// quick.
class Progress
{
public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done`: 0 ... 1. May be called at every step of a fast loop.
  void update(double done);

private:
  using Clock = std::chrono::steady_clock;

  void show(double done, double elapsed);

  const std::string what_;
  const bool terminal_;
  const Clock::time_point start_{ Clock::now() };
  Clock::time_point next_;
  Clock::time_point last_look_{ start_ };
  unsigned calls_{};  // since then
  unsigned calls_per_look_{ 1 };
  bool bar_shown_{};
};

/// A progress that lasts as long as the function: `result = analyse(..., showProgress("turning"));`
std::function<void(double)> showProgress(const std::string& what);

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
