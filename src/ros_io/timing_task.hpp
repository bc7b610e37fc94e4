// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <ros/time.h>

#include "live/realtime.hpp"
#include "live/twin_loop.hpp"
#include "ros_io/diagnostic_tasks.hpp"
#include "ros_io/recent_events.hpp"

namespace hjt
{
/// Whether a loop keeps up with the clock, as a task of /diagnostics. Also logs each jump of the clock, and when the
/// loop falls behind and is in time again.
class TimingTask
{
public:
  /// `deadline`: realtime.deadline [s].
  TimingTask(const RealtimeState& realtime, double deadline);

  /// Once a look. `dropped`: messages that could not be published.
  void update(const LoopStatus& loop, std::uint64_t dropped);

  DiagnosticVerdict judge() const;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

private:
  void log();

  const RealtimeState& realtime_;
  const double deadline_;
  LoopStatus loop_;
  RecentEvents drops_;
  RecentEvents clock_jumps_;
  RecentEvents missed_deadlines_;
  std::uint64_t logged_clock_jumps_{};
  bool is_behind_{};
  Stamp last_clock_{};
  ros::WallTime clock_moved_;
};
}  // namespace hjt
