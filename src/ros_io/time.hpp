// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <ros/time.h>

#include "harmonic_joint_twin/base/stamp.hpp"

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
}  // namespace hjt
