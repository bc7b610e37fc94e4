// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/common/configuration.hpp"
#include "recordings/recorded_signals.hpp"

namespace hjt
{
/// Options of signals without the common ones, which a command adds behind its own.
void addSignalOptions(Command& command, SignalOptions& options);
}  // namespace hjt
