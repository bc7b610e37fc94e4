// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <geometry_msgs/Inertia.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/Temperature.h>
#include <std_srvs/Trigger.h>
#include <trajectory_msgs/JointTrajectory.h>

#include "arm/goal_watch.hpp"
#include "arm/motion_limits.hpp"
#include "live/handover.hpp"
#include "live/inbox.hpp"
#include "live/realtime.hpp"
#include "live/try_lock_value.hpp"
#include "live/twin_loop.hpp"
#include "ros_io/arm_diagnostics.hpp"
#include "ros_io/arm_publishers.hpp"
#include "ros_io/driver_states.hpp"
#include "ros_io/fault_subscriber.hpp"
#include "ros_io/timing_publisher.hpp"

namespace hjt
{
/// The live twin of a whole arm, in place of a robot: moves gently until somebody commands a trajectory, publishes
/// what the robot's driver would, and takes faults of every joint.
class ArmNode
{
public:
  /// A motion and what counts as following it.
  struct Command
  {
    ArmMotion motion;
    ArmGoal goal;
  };

  /// `drives`: as ArmTwin takes them. Waits for their response surfaces, then starts. @throws ParameterError.
  ArmNode(ros::NodeHandle& node, const ArmDescription& arm, const std::vector<Parameters>& drives);

  /// From any thread: sets out on a trajectory, in place of what the arm did; without points it comes to rest. The goal
  /// gets its number. @returns why not, or nothing.
  std::string command(const trajectory_msgs::JointTrajectory& message, ArmGoal& goal);
  /// How the last command that the loop has taken is followed.
  GoalReport report() const { return advance_.report.read(); }
  const ArmDescription& description() const noexcept { return description_; }
  /// From any thread: in a protective stop why, else nothing.
  std::string stopReason() const;

private:
  enum class Unlock : std::uint8_t
  {
    NOT_ASKED,
    ASKED,
    DONE,
    MOVES
  };

  /// What the loop advances.
  class Advance : public Advanced
  {
  public:
    Advance(const ArmDescription& arm, const std::vector<Parameters>& drives);

    bool reset(Stamp stamp) noexcept override;
    void push(const LiveInput& input) noexcept override;
    bool step(Stamp until) noexcept override;
    Stamp stamp() const noexcept override { return arm.twin().stamp(); }
    void show(LoopStatus& status) noexcept override;

    MovingArm arm;
    Handover<Command> command;
    Handover<ArmWrench> wrench;
    Handover<Payload> payload;
    TryLockValue<std::vector<JointMotion>> shown;      ///< present set point
    TryLockValue<std::vector<TwinCounters>> counters;  ///< of each drive
    TryLockValue<GoalReport> report;
    std::atomic<const char*> stop_reason{ nullptr };  ///< of a protective stop; none: it moves
    std::atomic<std::size_t> stopped_joint{};         ///< of which joint
    std::atomic<Unlock> unlock{ Unlock::NOT_ASKED };

  private:
    std::vector<JointMotion> wanted_;
    std::vector<TwinCounters> counters_;
    GoalWatch watch_;
  };

  void receiveCommand(const trajectory_msgs::JointTrajectory& message);
  void give(std::vector<ArmSetPoint> points, ArmGoal& goal);
  void receiveWrench(const geometry_msgs::WrenchStamped& message);
  void receivePayload(const geometry_msgs::Inertia& message);
  void receiveTemperature(const sensor_msgs::Temperature& message);
  void tellOfStop();
  bool unlock(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  const ArmDescription description_;
  Inbox inbox_;
  Advance advance_;
  ArmPublishers publishers_;
  TwinLoop loop_;
  RealtimeState realtime_;
  TimingPublisher timing_publisher_;
  ArmDiagnostics diagnostics_;
  std::atomic<std::uint64_t> too_large_{ 0 };
  std::mutex command_mutex_;
  MotionLimits limits_;
  std::uint64_t commands_{};                              // given to the loop
  std::vector<std::unique_ptr<FaultSubscriber>> faults_;  // of each joint
  ros::Subscriber command_subscriber_;
  ros::Subscriber wrench_subscriber_;
  ros::Subscriber payload_subscriber_;
  ros::Subscriber temperature_subscriber_;
  ros::ServiceServer reset_service_;
  ros::ServiceServer unlock_service_;
  DriverStates driver_states_;
  bool told_of_stop_{};
  ros::WallTimer stop_timer_;
};
}  // namespace hjt
