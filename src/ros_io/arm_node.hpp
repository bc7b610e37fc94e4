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
/// How far a joint may be off its set point.
struct JointTolerance
{
  double position{ HUGE_VAL };  ///< [rad]
  double velocity{ HUGE_VAL };  ///< [rad/s]
};

/// Tolerances of a commanded motion.
struct ArmGoal
{
  std::uint64_t number{};            ///< of the command; later ones have larger numbers
  std::vector<JointTolerance> path;  ///< of each joint on the way; empty: nobody asks
  std::vector<JointTolerance> end;   ///< and when it is to be there
  double patience{};                 ///< how long after the motion's end that may be [s]
};

enum class GoalState : std::uint8_t
{
  NONE,       ///< nobody asks
  UNDER_WAY,  ///< on the way or not there yet
  REACHED,    ///< there in time
  OFF_PATH,   ///< beyond a tolerance on the way
  NOT_THERE,  ///< beyond a tolerance when the patience ended
  STOPPED,    ///< by a protective stop
  FORGOTTEN   ///< the arm was reset
};

/// How it follows. Of the last command taken.
struct GoalReport
{
  std::uint64_t number{};
  GoalState state{};
  Stamp stamp{};                    ///< at which all this was [ns]
  std::size_t joint{};              ///< the one beyond its tolerance
  bool is_speed{};                  ///< it was its speed's
  double error{};                   ///< by which it was off [rad], [rad/s]
  double tolerance{};               ///< likewise
  std::vector<JointMotion> wanted;  ///< set point
  std::vector<JointMotion> actual;  ///< reported by the controller, without accelerations
};

/// Judges at the arm's states whether it follows what it was commanded, as joint_trajectory_controller does. After
/// construction nothing throws or allocates.
class GoalWatch
{
public:
  GoalWatch(const ArmDescription& arm, const ArmTwin& twin)
    : period_(publishPeriod(arm.state_rate, twin.drive(0).parameters().solver.rate))
  {
    report_.wanted.resize(twin.joints());
    report_.actual.resize(twin.joints());
  }

  /// Of a motion that the arm follows from now on; in exchange for the last one.
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

  /// To be called at every step.
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
  /// The first joint that is, in the report.
  bool isBeyond(const std::vector<JointTolerance>& tolerances) noexcept
  {
    for (std::size_t i = 0; i < tolerances.size(); ++i)
    {
      const JointMotion& wanted = report_.wanted[i];
      const JointMotion& actual = report_.actual[i];
      const double angle = std::abs(wanted.position - actual.position);
      const double speed = std::abs(wanted.velocity - actual.velocity);
      // Written so that NaN is beyond.
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

  Stamp period_;  // of the states [ns]
  ArmGoal goal_;
  GoalReport report_;
};

/// What the twin of an arm publishes: joint_states as the robot's driver does, the tool's pose and the wanted one, and
/// of each drive what the twin of a joint publishes, below its own name.
class ArmPublishers
{
public:
  ArmPublishers(ros::NodeHandle& node, const ArmDescription& arm, const ArmTwin& twin);

  /// Loop: fills the messages due at the present instant that somebody hears. No allocation, no lock.
  void offer(MovingArm& arm) noexcept;

  /// Loop: as OutputPublishers::finishCycle.
  Stamp finishCycle(Stamp instant) noexcept;

  /// Messages that could not be published.
  std::uint64_t dropped() const noexcept;

private:
  using Pose = geometry_msgs::PoseStamped;

  bool isHeard() const noexcept;
  void drain();

  ros::NodeHandle parent_;
  std::vector<std::size_t> order_;  // joints in that of the driver's messages
  Stamp period_;                    // [ns]
  ArmDynamics dynamics_;
  std::vector<JointMotion> wanted_;
  std::vector<std::unique_ptr<OutputPublishers>> drives_;
  OutputChannel<sensor_msgs::JointState> states_;
  OutputChannel<Pose> tool_;
  OutputChannel<Pose> wanted_tool_;
  PublisherThread thread_;  // last: it uses the rest
};

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

/// The newest of some values from callbacks to a loop, which never waits and frees nothing.
template <class Value>
class Handover
{
public:
  explicit Handover(Value unused) : value_(std::move(unused)) {}

  /// From any thread, in place of one that was not taken.
  void give(Value value)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    value_ = std::move(value);
    is_new_ = true;
  }

  /// From the loop: calls `use(Value&)` if there is a new one. What is in the value then is freed by the next `give`.
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

/// State of the robot as ur_robot_driver publishes it, by its names, latched: robot and safety mode, whether it takes
/// commands, the share of its speed. The modes are messages of ur_dashboard_msgs, which need not be there.
class DriverStates
{
public:
  /// `parent`: of the driver's names.
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

/// Offers the action FollowJointTrajectory below the controller's name, `~controller`, as the arm's driver does, for as
/// long as what it returns lives. Where control_msgs was not found nothing, and the log says so.
std::shared_ptr<void> offerArmAction(ros::NodeHandle& node, ArmNode& arm);

/// The live twin of an arm with its action.
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
