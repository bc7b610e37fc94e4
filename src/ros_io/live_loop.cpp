// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/live_loop.hpp"

#include <string>

#include <ros/console.h>

#include "messages/time.hpp"

namespace hjt
{
Stamp rosNow()
{
  return fromRosTime(ros::Time::now());
}

ClockKind rosClockKind()
{
  return ros::Time::isSimTime() ? ClockKind::STEPPED : ClockKind::RUNNING;
}

RealtimeState requestRealtime(const RealtimeParameters& parameters, TwinLoop& loop)
{
  RealtimeState state = applyRealtime(parameters, loop.thread());
  for (const std::string& refusal : state.refusals)
  {
    ROS_WARN_STREAM(refusal);
  }
  return state;
}
}  // namespace hjt
