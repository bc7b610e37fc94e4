// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <csignal>

namespace hjt
{
/// The signal that came within an InterruptScope, or 0.
int interruptSignal();

/// While it lives, SIGINT, SIGTERM and SIGHUP end loops that ask for `interruptSignal` instead of the process, so
/// that files are closed; a second one ends the process. A scope within another changes nothing.
class InterruptScope
{
public:
  InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
  ~InterruptScope();

private:
  struct Caught
  {
    int signal{};
    struct sigaction before
    {
    };
  };

  static void catchSignal(Caught& caught, int signal);

  const bool is_outer_;
  std::array<Caught, 3> caught_{};  // without a signal: not caught
};
}  // namespace hjt
