// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <ros/console.h>

#include "live/realtime.hpp"
#include "live/twin_loop.hpp"
#include "messages/time.hpp"

namespace hjt
{
/// By the clock of ROS [ns].
inline Stamp rosNow()
{
  return fromRosTime(ros::Time::now());
}

/// Whether the clock is the system's or somebody's on /clock, which is settled once the node runs.
inline ClockKind rosClockKind()
{
  return ros::Time::isSimTime() ? ClockKind::STEPPED : ClockKind::RUNNING;
}

/// Requests the parameters below `realtime` from the system; refusals are logged.
inline RealtimeState requestRealtime(const RealtimeParameters& parameters, TwinLoop& loop)
{
  RealtimeState state = applyRealtime(parameters, loop.thread());
  for (const std::string& refusal : state.refusals)
  {
    ROS_WARN_STREAM(refusal);
  }
  return state;
}
}  // namespace hjt
