// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "live/realtime.hpp"
#include "live/twin_loop.hpp"

namespace hjt
{
/// By the clock of ROS [ns].
Stamp rosNow();

/// Whether the clock is the system's or somebody's on /clock, which is settled once the node runs.
ClockKind rosClockKind();

/// Requests the parameters below `realtime` from the system; refusals are logged.
RealtimeState requestRealtime(const RealtimeParameters& parameters, TwinLoop& loop);
}  // namespace hjt
