// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <string>

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
}  // namespace hjt
