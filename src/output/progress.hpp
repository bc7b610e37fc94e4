// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "harmonic_joint_twin/surface/surface_source.hpp"

namespace hjt
{
/// Prints the progress of a task to stderr: a bar on a terminal, elsewhere a line every few seconds. Prints nothing for
/// a task that ends before the first bar or line is due.
class Progress
{
public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Updates the printed progress. `done`: finished share, 0 ... 1. May be called at every step of a fast loop.
  void update(double done);

private:
  using Clock = std::chrono::steady_clock;

  void show(double done, double elapsed);

  const std::string what_;
  const bool terminal_;
  const Clock::time_point start_{ Clock::now() };
  Clock::time_point next_;
  Clock::time_point last_look_{ start_ };
  unsigned calls_{};  // number of calls since the last reading of the clock
  unsigned calls_per_look_{ 1 };
  bool bar_shown_{};
};

/// Function that prints the progress of a call: `result = analyse(..., showProgress("turning"));`
std::function<void(double)> showProgress(const std::string& what);

/// Callbacks by which a caller follows the progress of a long function, and ends the function. An exception of a
/// callback ends the function at once.
struct Watch
{
  /// Called with the name of a step when the step begins. Returns the function that receives its progress, 0 ... 1.
  std::function<std::function<void(double)>(const std::string&)> progress{ [](const std::string&)
                                                                           { return [](double) {}; } };
  /// Called at every row and between steps. If the callback returns true, the function closes its files and ends.
  std::function<bool()> stopped{ [] { return false; } };
  /// Receives a note for the user: a sentence without full stop.
  std::function<void(const std::string&)> notice{ [](const std::string&) {} };
};

/// Thrown if the caller ends a function before it has a result.
struct Stopped
{
};

/// Source of response surfaces with the user's cache. Building a surface throws `Stopped` if the watch stops.
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
