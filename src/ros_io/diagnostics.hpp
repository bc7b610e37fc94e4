// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "live/realtime.hpp"
#include "live/thread_exchange.hpp"
#include "live/twin_loop.hpp"
#include "ros_io/diagnostic_tasks.hpp"
#include "ros_io/input_subscribers.hpp"
#include "ros_io/output_publishers.hpp"

namespace hjt
{
/// Text of the assessment. A reported fault stays in the text until later windows contradict the fault.
std::string verdictText(const Assessment& assessment);

/// Adds cause, evidence and windows of an assessment to the diagnostics.
void addAssessment(const Assessment& assessment, diagnostic_updater::DiagnosticStatusWrapper& status);

/// Publishes the state of drive, input, timing and health of a twin on /diagnostics.
class Diagnostics
{
public:
  Diagnostics(ros::NodeHandle& node, const Parameters& parameters, const TwinLoop& loop, const RealtimeState& realtime,
              const Inbox& inbox, const InputSubscribers& subscribers, const OutputPublishers& publishers);

private:
  /// Data that the tasks use, read once for each update.
  struct Snapshot
  {
    LoopStatus loop;
    MessageCounters messages;
    std::uint64_t not_finite{};
    std::uint64_t overflow{};
    std::array<ChannelCounters, CHANNEL_COUNT> outputs{};
  };

  void readSnapshot();
  DiagnosticVerdict judgeDrive() const;
  DiagnosticVerdict judgeInput() const;
  DiagnosticVerdict judgeTiming() const { return timing_.judge(); }
  DiagnosticVerdict judgeHealth() const;
  void reportDrive(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void reportInput(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void reportTiming(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void reportHealth(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  const TwinLoop& loop_;
  const Inbox& inbox_;
  const InputSubscribers& subscribers_;
  const OutputPublishers& publishers_;
  const double command_timeout_;
  Snapshot snapshot_;
  RecentEvents solver_failures_;
  RecentEvents step_cuts_;
  RecentEvents jumps_;
  RecentEvents coarse_steps_;
  RecentEvents speed_limits_;
  RecentEvents overloads_;
  RecentEvents refusals_;
  RecentEvents clamps_;
  RecentEvents late_inputs_;
  RecentEvents timeouts_;
  RecentEvents lost_inputs_;
  TimingTask timing_;
  DiagnosticTasks tasks_;
  ros::WallTimer timer_;
};
}  // namespace hjt
