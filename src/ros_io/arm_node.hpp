// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <geometry_msgs/Inertia.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Temperature.h>
#include <std_srvs/Trigger.h>
#include <trajectory_msgs/JointTrajectory.h>

#include "arm/arm_description.hpp"
#include "arm/goal_watch.hpp"
#include "arm/motion_limits.hpp"
#include "arm/moving_arm.hpp"
#include "live/realtime.hpp"
#include "live/thread_exchange.hpp"
#include "live/twin_loop.hpp"
#include "ros_io/diagnostic_tasks.hpp"
#include "ros_io/input_subscribers.hpp"
#include "ros_io/output_publishers.hpp"

namespace hjt
{
/// The topics of an arm's twin: joint_states as of the robot's driver, actual and wanted pose of the tool, and for each
/// drive the topics of a joint's twin in its own namespace.
class ArmPublishers
{
public:
  ArmPublishers(ros::NodeHandle& node, const ArmDescription& arm, const ArmTwin& twin);

  /// For the loop: fills the due messages that have subscribers. It neither allocates nor locks.
  void offer(MovingArm& arm) noexcept;

  /// For the loop: as OutputPublishers::finishCycle.
  Stamp finishCycle(Stamp instant) noexcept;

  /// Number of messages that could not be published.
  std::uint64_t dropped() const noexcept;

private:
  using Pose = geometry_msgs::PoseStamped;

  bool isHeard() const noexcept;
  void drain();

  ros::NodeHandle parent_;
  std::vector<std::size_t> order_;  // indices of the joints in the order of the driver's messages
  Stamp period_;                    // period of joint_states [ns]
  ArmDynamics dynamics_;
  std::vector<JointMotion> wanted_;
  std::vector<std::unique_ptr<OutputPublishers>> drives_;
  OutputChannel<sensor_msgs::JointState> states_;
  OutputChannel<Pose> tool_;
  OutputChannel<Pose> wanted_tool_;
  PublisherThread thread_;  // last, because it uses the other members
};

/// State of the arm's twin in /diagnostics: whether it moves, which drives are overloaded, and whether the loop is in
/// time.
class ArmDiagnostics
{
public:
  /// State at one update, read in the caller's thread.
  struct Snapshot
  {
    LoopStatus loop;
    std::vector<TwinCounters> drives;
    std::string stop_reason;  ///< reason of a protective stop; empty: no stop
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
  std::vector<RecentEvents> failures_;   // for each joint
  std::vector<RecentEvents> overloads_;  // for each joint
  TimingTask timing_;
  DiagnosticTasks tasks_;
  ros::WallTimer timer_;
};

/// Passes the newest value from callbacks to a loop that neither waits nor frees memory.
template <class Value>
class Handover
{
public:
  explicit Handover(Value unused) : value_(std::move(unused)) {}

  /// Sets the value, which replaces one that was not taken; thread-safe.
  void give(Value value)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    value_ = std::move(value);
    is_new_ = true;
  }

  /// For the loop: calls `use(Value&)` if there is a new value. The next `give` frees the content of the used one.
  template <class Use>
  void take(Use&& use) noexcept
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (lock.owns_lock() && is_new_)
    {
      use(value_);
      is_new_ = false;
    }
  }

private:
  std::mutex mutex_;
  Value value_;
  bool is_new_{};
};

/// State of the robot with the topic names of ur_robot_driver, latched: robot mode, safety mode, whether it accepts
/// commands, and the speed scaling. The modes are messages of ur_dashboard_msgs, which need not be installed.
class DriverStates
{
public:
  /// `parent`: namespace of the driver's names.
  explicit DriverStates(const ros::NodeHandle& parent);

  /// Publishes what has changed.
  void show(bool protective_stop);

private:
  std::optional<bool> shown_;
  ros::NodeHandle parent_;
  ros::Publisher robot_mode_;
  ros::Publisher safety_mode_;
  ros::Publisher program_;
  ros::Publisher speed_scaling_;
};

/// The live twin of a whole arm without a robot. It moves gently until a trajectory is commanded, publishes the topics
/// of the robot's driver, and accepts faults of every joint.
class ArmNode
{
public:
  struct Command
  {
    ArmMotion motion;
    ArmGoal goal;
  };

  /// `drives`: parameters as for ArmTwin. The constructor waits for the response surfaces and starts the arm. @throws
  /// ParameterError.
  ArmNode(ros::NodeHandle& node, const ArmDescription& arm, const std::vector<Parameters>& drives);

  /// Begins a trajectory that replaces the present motion; without points the arm comes to rest. `goal` receives its
  /// number. Thread-safe. @returns the reason of a refusal; empty if the trajectory is accepted.
  std::string command(const trajectory_msgs::JointTrajectory& message, ArmGoal& goal);
  /// Report on the last command that the loop has taken.
  GoalReport report() const { return advance_.report.read(); }
  const ArmDescription& description() const noexcept { return description_; }
  /// Reason of a protective stop; empty without a stop. Thread-safe.
  std::string stopReason() const;

private:
  enum class Unlock : std::uint8_t
  {
    NOT_ASKED,
    ASKED,
    DONE,
    MOVES
  };

  /// The object that the loop advances.
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
    TryLockValue<std::vector<JointMotion>> shown;      ///< present set points
    TryLockValue<std::vector<TwinCounters>> counters;  ///< counts of each drive
    TryLockValue<GoalReport> report;
    std::atomic<const char*> stop_reason{ nullptr };  ///< reason of a protective stop; null: no stop
    std::atomic<std::size_t> stopped_joint{};         ///< joint of the protective stop
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
  std::uint64_t commands_{};                              // number of commands given to the loop
  std::vector<std::unique_ptr<FaultSubscriber>> faults_;  // for each joint
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

/// Offers the action FollowJointTrajectory in the namespace of `~controller`, as the robot's driver does, during the
/// lifetime of the result. Without control_msgs at build time it offers nothing and logs this.
std::shared_ptr<void> offerArmAction(ros::NodeHandle& node, ArmNode& arm);

/// The live twin of an arm with its action server.
class ArmWithAction
{
public:
  ArmWithAction(ros::NodeHandle& node, const ArmDescription& arm, const std::vector<Parameters>& drives)
    : arm_(node, arm, drives), action_(offerArmAction(node, arm_))
  {
  }

private:
  ArmNode arm_;
  std::shared_ptr<void> action_;
};
}  // namespace hjt
