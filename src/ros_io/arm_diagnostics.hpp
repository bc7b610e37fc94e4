// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include "arm/arm_description.hpp"
#include "live/realtime.hpp"
#include "live/twin_loop.hpp"
#include "ros_io/diagnostic_tasks.hpp"
#include "ros_io/recent_events.hpp"
#include "ros_io/timing_task.hpp"

namespace hjt
{
/// What the twin of an arm says of itself to /diagnostics: whether it moves, what its drives cannot bear, and whether
/// it keeps up with the clock.
class ArmDiagnostics
{
public:
  /// Read once a look, from whoever spins.
  struct Snapshot
  {
    LoopStatus loop;
    std::vector<TwinCounters> drives;
    std::string stop_reason;  ///< of a protective stop; empty: it moves
    std::uint64_t dropped{};  ///< messages that could not be published
  };
  using Read = std::function<Snapshot()>;

  ArmDiagnostics(ros::NodeHandle& node, const ArmDescription& arm, const Parameters& parameters,
                 const RealtimeState& realtime, Read read);

private:
  void look();
  std::string namesOf(const std::vector<RecentEvents>& events) const;
  DiagnosticVerdict judge() const;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  const ArmDescription& arm_;
  const Read read_;
  Snapshot snapshot_;
  std::vector<RecentEvents> failures_;   // of each joint
  std::vector<RecentEvents> overloads_;  // likewise
  TimingTask timing_;
  DiagnosticTasks tasks_;
  ros::WallTimer timer_;
};
}  // namespace hjt
