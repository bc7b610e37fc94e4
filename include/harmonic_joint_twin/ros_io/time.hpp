// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <ros/time.h>

#include "harmonic_joint_twin/twin/input_queue.hpp"

namespace hjt
{
/// ROS time of a stamp [ns]; a stamp before the epoch, which ROS cannot say, becomes zero.
inline ros::Time toRosTime(Stamp stamp)
{
  ros::Time time;
  time.fromNSec(stamp > 0 ? static_cast<std::uint64_t>(stamp) : 0);
  return time;
}

/// Stamp [ns] of a ROS time.
inline Stamp fromRosTime(const ros::Time& time)
{
  return static_cast<Stamp>(time.toNSec());
}

/// Stamp difference [ns] of a duration [s].
inline Stamp toStampLength(double duration)
{
  return static_cast<Stamp>(duration * 1e9 + 0.5);
}

/// Duration [s] of a stamp difference [ns].
inline double toSeconds(Stamp length)
{
  return static_cast<double>(length) / 1e9;
}
}  // namespace hjt
