// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

namespace hjt
{
/// From here on SIGINT and SIGTERM end loops instead of the process, so that files are closed.
void catchInterrupts();

/// The signal that came, or 0.
int interruptSignal();

/// SIGINT ends loops as long as it lives, in a process with handlers of its own. One at a time.
class InterruptScope
{
public:
  InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
  ~InterruptScope();

private:
  struct sigaction before_
  {
  };
};
}  // namespace hjt
