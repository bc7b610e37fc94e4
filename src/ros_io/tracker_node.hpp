// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <std_srvs/Trigger.h>

#include "ros_io/diagnostics.hpp"
#include "ros_io/life_publisher.hpp"
#include "ros_io/recent_events.hpp"
#include "ros_io/telemetry_messages.hpp"
#include "tracking/tracker.hpp"

namespace hjt
{
/// The twin beside a robot, live: wires a `Tracker` to topics, diagnostics and a service. Whatever a message brings is
/// worked off in its callback: nothing here waits for a clock.
class TrackerNode
{
public:
  /// @param parameters with input.mode other than commands. @throws ParameterError.
  TrackerNode(ros::NodeHandle& node, const Parameters& parameters);

private:
  using JointStateEvent = ros::MessageEvent<const sensor_msgs::JointState>;

  /// Messages that brought nothing.
  struct Refusals
  {
    std::uint64_t unknown_joint{};
    std::uint64_t incomplete{};
    std::uint64_t not_finite{};
    std::uint64_t load{};
    std::uint64_t far_stamp{};
  };

  struct LoadAt
  {
    std::optional<Stamp> stamp;  // none: valid from its reception on [ns]
    Stamp received;              // [ns]
    double torque;               // [N.m]
  };

  void receiveTelemetry(const JointStateEvent& event);
  void receiveLoad(const JointStateEvent& event);
  void receiveLoadTorque(const ros::MessageEvent<const std_msgs::Float64>& event);
  void pushLoad(const LoadAt& load);
  void passLoad(const LoadAt& load);
  bool start(Stamp stamp);
  double secondsFromStart(Stamp stamp) const { return toSeconds(stamp - *start_); }
  void publish();
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  void look();
  DiagnosticVerdict judgeTelemetry() const;
  DiagnosticVerdict judgeComparison() const;
  DiagnosticVerdict judgeHealth() const;
  bool hasStopped() const;
  void reportTelemetry(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void reportComparison(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void reportHealth(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  std::mutex mutex_;  // of everything below: callbacks run in several threads
  const JointNames names_;
  const Parameters parameters_;
  Tracker tracker_;
  LifePublisher life_;
  std::optional<Stamp> start_;            // stamp of the first row: the tracker's zero [ns]
  Stamp last_received_{};                 // [ns]
  Stamp offset_{};                        // of the last row taken: reception less stamp [ns]
  std::optional<Stamp> refused_offset_;   // of the last row, if its stamp was refused [ns]
  std::uint64_t clock_changes_{};         // restarts because all stamps had moved far
  std::optional<Stamp> last_load_stamp_;  // [ns]
  std::deque<LoadAt> early_loads_;        // received before the start
  std::string found_names_;               // in the last message without this joint
  Refusals refusals_;
  harmonic_joint_twin::Comparison comparison_;
  harmonic_joint_twin::Indicators indicators_;
  harmonic_joint_twin::Assessment assessment_;
  std::int64_t indicators_period_;  // [ns]
  std::int64_t indicators_due_{};   // how many periods have begun since the epoch
  RecentEvents recent_refusals_;
  RecentEvents recent_disorder_;
  RecentEvents recent_missing_;
  RecentEvents recent_restarts_;
  RecentEvents recent_failures_;
  ros::Publisher comparison_publisher_;
  ros::Publisher indicators_publisher_;
  ros::Publisher assessment_publisher_;
  DiagnosticTasks tasks_;
  ros::ServiceServer reset_service_;
  ros::WallTimer timer_;
  std::atomic<std::uint64_t> too_large_{ 0 };
  ros::Subscriber telemetry_subscriber_;
  ros::Subscriber load_subscriber_;
  ros::Subscriber load_torque_subscriber_;
};
}  // namespace hjt
