// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// From here on SIGINT and SIGTERM end loops instead of the process, so that files are closed.
void catchInterrupts();

/// The signal that came, or 0.
int interruptSignal();
}  // namespace hjt
