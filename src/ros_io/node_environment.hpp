// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <string>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/names.h>
#include <ros/this_node.h>

#include "arm/arm_description.hpp"
#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "live/realtime.hpp"
#include "live/twin_loop.hpp"
#include "messages/time.hpp"

namespace hjt
{
/// Time of the ROS clock [ns].
inline Stamp rosNow()
{
  return fromRosTime(ros::Time::now());
}

/// Kind of the ROS clock: that of the system, or simulated on /clock. Known after the start of the node.
inline ClockKind rosClockKind()
{
  return ros::Time::isSimTime() ? ClockKind::STEPPED : ClockKind::RUNNING;
}

/// Requests from the system the settings of section realtime. Logs each refused request.
inline RealtimeState requestRealtime(const RealtimeParameters& parameters, TwinLoop& loop)
{
  RealtimeState state = applyRealtime(parameters, loop.thread());
  for (const std::string& refusal : state.refusals)
  {
    ROS_WARN_STREAM(refusal);
  }
  return state;
}

/// Source of response surfaces with the user's cache, and with progress and notices in the log. `background`: see
/// SurfaceSource.
inline SurfaceSource nodeSurfaceSource(bool background)
{
  return { surfaceCacheDirectory(),
           [](double done) { ROS_INFO_THROTTLE(2.0, "building the response surface: %.0f %%", 100.0 * done); },
           [](const std::string& what) { ROS_WARN_STREAM(what); },
           {},
           background };
}

/// Makes SIGTERM and SIGHUP end a node as SIGINT does, because roscpp handles only SIGINT. A SIGHUP that nohup ignores
/// stays ignored. SIGXFSZ is ignored, so that a write beyond the limit of file sizes fails like a write to a full disk.
/// Must be called after ros::init.
inline void shutDownOnSignals()
{
  const auto request = [](int) { ros::requestShutdown(); };
  std::signal(SIGTERM, request);
  std::signal(SIGXFSZ, SIG_IGN);
  if (std::signal(SIGHUP, request) == SIG_IGN)
  {
    std::signal(SIGHUP, SIG_IGN);
  }
}

/// Namespace of the topics of an arm's joint: NAMESPACE/SHORT_NAME/NODE.
inline std::string jointName(const ArmJoint& joint)
{
  const std::string& name = ros::this_node::getName();
  const std::string node = name.substr(name.rfind('/') + 1);
  return ros::names::append(ros::names::parentNamespace(name), joint.short_name + "/" + node);
}
}  // namespace hjt
