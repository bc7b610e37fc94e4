// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/JointState.h>

#include "harmonic_joint_twin/Comparison.h"
#include "harmonic_joint_twin/Verdict.h"
#include "messages/conversions.hpp"
#include "tracking/tracker.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
/// Values of a joint in a robot's telemetry.
enum class TelemetryStatus
{
  FOUND,
  UNKNOWN_JOINT,  ///< no entry for this joint
  INCOMPLETE,     ///< named, but without a position or an effort
  NOT_FINITE,     ///< the position is NaN or Inf
  WITHOUT_EFFORT  ///< a position, but the effort is NaN or Inf: the row holds all but the current
};

/// Position [rad], velocity if there is one [rad/s] and effort, as current, of the joint; where the message names its
/// motor too, that one's position. Times and load of the row stay as they are.
TelemetryStatus readTelemetry(const sensor_msgs::JointState& message, const JointNames& names, MotionRow& row) noexcept;

/// @param stamp of the row [ns].
void fillComparison(Stamp stamp, const Comparison& comparison, harmonic_joint_twin::Comparison& message) noexcept;

/// @param stamp of the last row that was judged [ns]. Allocates.
void fillVerdict(Stamp stamp, const Verdict& verdict, harmonic_joint_twin::Verdict& message);
}  // namespace hjt
