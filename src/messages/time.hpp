// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <string>

#include <ros/time.h>

#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt
{
// The program computes time differences from stamps, because time differences of ros::Time throw beyond 68 years.

/// Latest time that ROS can represent [ns].
constexpr Stamp LAST_ROS_STAMP = 4'294'967'295'999'999'999;

/// Converts a stamp to ROS time, limited to the range of ROS.
inline ros::Time toRosTime(Stamp stamp)
{
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(std::clamp<Stamp>(stamp, 0, LAST_ROS_STAMP)));
  return time;
}

/// Converts a ROS time to a stamp [ns]. The ROS time may contain more than 1e9 nanoseconds.
inline Stamp fromRosTime(const ros::Time& time)
{
  return std::min(static_cast<Stamp>(time.toNSec()), LAST_ROS_STAMP);
}

/// The stamp of a header or, if the header has none, the time of reception [ns].
inline Stamp stampOr(const ros::Time& header_stamp, const ros::Time& received)
{
  return fromRosTime(header_stamp.isZero() ? received : header_stamp);
}

/// Text of a date in UTC. `format` is that of strftime; the text has at most 31 characters.
inline std::string dateText(Stamp date, const char* format)
{
  constexpr Stamp SECOND = 1'000'000'000;
  const auto seconds = static_cast<std::time_t>(date / SECOND);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  return { text.data(), std::strftime(text.data(), text.size(), format, &parts) };
}
}  // namespace hjt
