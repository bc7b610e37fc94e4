// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cmath>
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
#include "arm/moving_arm.hpp"
#include "arm/set_points.hpp"
#include "base/publish_period.hpp"
#include "live/realtime.hpp"
#include "live/thread_exchange.hpp"
#include "live/twin_loop.hpp"
#include "ros_io/diagnostic_tasks.hpp"
#include "ros_io/input_subscribers.hpp"
#include "ros_io/output_publishers.hpp"

namespace hjt
{
/// Largest deviation of a joint from its set point that a goal permits.
struct JointTolerance
{
  double position{ HUGE_VAL };  ///< largest deviation of the angle [rad]
  double velocity{ HUGE_VAL };  ///< largest deviation of the speed [rad/s]
};

/// Goal of a commanded motion: tolerances that the joints must keep.
struct ArmGoal
{
  std::uint64_t number{};            ///< number of the command; each command has a larger number than the one before
  std::vector<JointTolerance> path;  ///< tolerances of the joints during the motion; empty: no goal
  std::vector<JointTolerance> end;   ///< tolerances of the joints at the end of the motion
  double patience{};                 ///< time after the end of the motion within which the arm must arrive [s]
};

enum class GoalState : std::uint8_t
{
  NONE,       ///< no goal
  UNDER_WAY,  ///< the arm moves, or has not arrived yet
  REACHED,    ///< the arm arrived in time
  OFF_PATH,   ///< a joint exceeded its tolerance during the motion
  NOT_THERE,  ///< a joint exceeded its tolerance at the end of ArmGoal::patience
  STOPPED,    ///< a protective stop ended the motion
  FORGOTTEN   ///< a reset of the arm ended the motion
};

/// Report on how the arm follows the last command that the loop has taken.
struct GoalReport
{
  std::uint64_t number{};
  GoalState state{};
  Stamp stamp{};                    ///< time of `wanted` and `actual` [ns]
  std::size_t joint{};              ///< index of the first joint that exceeds its tolerance
  bool is_speed{};                  ///< whether the speed of `joint` exceeds its tolerance; false: the angle does
  double error{};                   ///< deviation of `joint` from its set point [rad], [rad/s]
  double tolerance{};               ///< tolerance of `joint` [rad], [rad/s]
  std::vector<JointMotion> wanted;  ///< set points of the joints
  std::vector<JointMotion> actual;  ///< states of the joints as the controller reports them, without accelerations
};

/// Judges at each step whether the arm follows its command, as joint_trajectory_controller does. After construction no
/// function throws or allocates.
class GoalWatch
{
public:
  GoalWatch(const ArmDescription& arm, const ArmTwin& twin)
    : period_(publishPeriod(arm.state_rate, twin.drive(0).parameters().solver.rate))
  {
    report_.wanted.resize(twin.joints());
    report_.actual.resize(twin.joints());
  }

  /// Takes the goal of the motion that the arm follows from now on. Stores the previous goal in `goal`.
  void begin(ArmGoal& goal) noexcept
  {
    std::swap(goal_, goal);
    report_.number = goal_.number;
    report_.state = goal_.path.empty() ? GoalState::NONE : GoalState::UNDER_WAY;
  }

  void forget() noexcept
  {
    report_.state = report_.state == GoalState::UNDER_WAY ? GoalState::FORGOTTEN : report_.state;
  }

  /// Updates the report on the goal. Must be called at every step of the arm.
  void look(MovingArm& arm) noexcept
  {
    if (report_.state != GoalState::UNDER_WAY || arm.twin().stamp() % period_ != 0)
    {
      return;
    }
    report_.stamp = arm.twin().stamp();
    arm.wanted(report_.wanted);
    for (std::size_t i = 0; i < report_.actual.size(); ++i)
    {
      const JointReading reading = arm.reading(i);
      report_.actual[i] = { reading.position, reading.velocity, 0.0 };
    }
    const double left = arm.commandLeft();
    if (arm.protectiveStop())
    {
      report_.state = GoalState::STOPPED;
    }
    else if (left > 0.0)
    {
      report_.state = isBeyond(goal_.path) ? GoalState::OFF_PATH : GoalState::UNDER_WAY;
    }
    else if (!isBeyond(goal_.end))
    {
      report_.state = GoalState::REACHED;
    }
    else if (-left > goal_.patience)
    {
      report_.state = GoalState::NOT_THERE;
    }
  }

  const GoalReport& report() const noexcept { return report_; }

private:
  /// Whether a joint exceeds its tolerance. If so, the first such joint is stored in the report.
  bool isBeyond(const std::vector<JointTolerance>& tolerances) noexcept
  {
    for (std::size_t i = 0; i < tolerances.size(); ++i)
    {
      const JointMotion& wanted = report_.wanted[i];
      const JointMotion& actual = report_.actual[i];
      const double angle = std::abs(wanted.position - actual.position);
      const double speed = std::abs(wanted.velocity - actual.velocity);
      // This form of the comparison counts NaN as beyond the tolerance.
      report_.is_speed = angle <= tolerances[i].position;
      if (!report_.is_speed || !(speed <= tolerances[i].velocity))
      {
        report_.joint = i;
        report_.error = report_.is_speed ? speed : angle;
        report_.tolerance = report_.is_speed ? tolerances[i].velocity : tolerances[i].position;
        return true;
      }
    }
    return false;
  }

  Stamp period_;  // period of the controller's states [ns]
  ArmGoal goal_;
  GoalReport report_;
};

/// The topics of an arm's twin: joint_states like that of the robot's driver, and actual and wanted pose of the tool.
/// Each drive has the topics of a joint's twin in a separate namespace.
class ArmPublishers
{
public:
  ArmPublishers(ros::NodeHandle& node, const ArmDescription& arm, const ArmTwin& twin);

  /// For the loop: fills the due messages that have subscribers. The call neither allocates nor locks.
  void offer(MovingArm& arm) noexcept;

  /// For the loop: as OutputPublishers::finishCycle, for the topics of all drives and of the arm.
  Stamp finishCycle(Stamp instant) noexcept;

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
  PublisherThread thread_;  // last member, because the thread uses the other members
};

/// State of the arm's twin in /diagnostics: whether a protective stop holds the arm, which drives are overloaded, and
/// whether the loop is in time.
class ArmDiagnostics
{
public:
  /// State of the arm at one update of the diagnostics.
  struct Snapshot
  {
    LoopStatus loop;
    std::vector<TwinCounters> drives;
    std::string stop_reason;  ///< reason of a protective stop; empty: no stop
    std::uint64_t dropped{};  ///< number of messages that could not be published
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
  std::vector<RecentEvents> failures_;   // failed steps of each joint
  std::vector<RecentEvents> overloads_;  // overloads of each joint
  TimingTask timing_;
  DiagnosticTasks tasks_;
  ros::WallTimer timer_;
};

/// Passes the newest value from callbacks to a loop. The loop neither waits nor frees memory.
template <class Value>
class Handover
{
public:
  explicit Handover(Value unused) : value_(std::move(unused)) {}

  /// Sets the value, which replaces a value that the loop has not yet taken. Thread-safe.
  void give(Value value)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    value_ = std::move(value);
    is_new_ = true;
  }

  /// For the loop: calls `use(Value&)` if there is a new value. The next `give` frees the memory of the used value.
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

/// State of the robot on latched topics with the names of ur_robot_driver: robot mode, safety mode, whether the robot
/// accepts commands, and speed scaling. The modes are messages of ur_dashboard_msgs, which need not be installed.
class DriverStates
{
public:
  /// `parent`: namespace in which the driver publishes.
  explicit DriverStates(const ros::NodeHandle& parent);

  /// Publishes each state that has changed.
  void show(bool protective_stop);

private:
  std::optional<bool> shown_;
  ros::NodeHandle parent_;
  ros::Publisher robot_mode_;
  ros::Publisher safety_mode_;
  ros::Publisher program_;
  ros::Publisher speed_scaling_;
};

/// The live twin of a whole arm without a robot. The arm moves gently until a trajectory is commanded. The node
/// publishes the topics of the robot's driver and accepts faults of every joint.
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

  /// Begins a trajectory, which replaces the present motion. Without points the arm comes to rest. `goal` receives the
  /// number of the command. Thread-safe. @returns the reason of a refusal; empty if the trajectory is accepted.
  std::string command(const trajectory_msgs::JointTrajectory& message, ArmGoal& goal);
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

  /// The arm, as the loop advances it.
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
    TryLockValue<std::vector<TwinCounters>> counters;  ///< counted events of each drive
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
  std::vector<std::unique_ptr<FaultSubscriber>> faults_;  // subscriber of the faults of each joint
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

/// Offers the action FollowJointTrajectory in the namespace of `~controller`, as the robot's driver does, while the
/// result exists. If control_msgs was missing at build time, the function only logs that no action exists.
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
