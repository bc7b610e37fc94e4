// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/arm_node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <ros/console.h>
#include <ros/names.h>
#include <ros/serialization.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>
#include <topic_tools/shape_shifter.h>

#include "arm/arm_configuration.hpp"
#include "base/range.hpp"
#include "base/text.hpp"
#include "messages/channels.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "ros_io/arm_trajectory.hpp"
#include "ros_io/node_environment.hpp"
#include "surface/surface_cache.hpp"

namespace hjt
{
namespace
{
constexpr const char* TOOL_POSE = "tool_pose";
constexpr const char* WANTED_TOOL_POSE = "wanted_tool_pose";

template <class Message>
Channel<Message> channelOf(const char* name)
{
  return { name, nullptr, SMALL_MESSAGE_SLOTS, nullptr, nullptr };
}

geometry_msgs::PoseStamped makePose(const ArmDescription& arm)
{
  geometry_msgs::PoseStamped message;
  message.header.frame_id = arm.base;
  return message;
}

bool fillPose(Stamp stamp, const ToolPose& pose, geometry_msgs::PoseStamped& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.pose.position.x = pose.position[0];
  message.pose.position.y = pose.position[1];
  message.pose.position.z = pose.position[2];
  message.pose.orientation.x = pose.orientation[0];
  message.pose.orientation.y = pose.orientation[1];
  message.pose.orientation.z = pose.orientation[2];
  message.pose.orientation.w = pose.orientation[3];
  return true;
}
}  // namespace

ArmPublishers::ArmPublishers(ros::NodeHandle& node, const ArmDescription& arm, const ArmTwin& twin)
  : order_(driverOrder(arm))
  , period_(publishPeriod(arm.state_rate, twin.drive(0).parameters().solver.rate))
  , dynamics_(arm)
  , wanted_(arm.joints.size())
  , states_(&parent_, channelOf<sensor_msgs::JointState>(topics::JOINT_STATES), jointStatesOf(driverNames(arm)))
  , tool_(&node, channelOf<Pose>(TOOL_POSE), makePose(arm))
  , wanted_tool_(&node, channelOf<Pose>(WANTED_TOOL_POSE), makePose(arm))
  , thread_([this] { drain(); }, [this] { return isHeard(); })
{
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    ros::NodeHandle joint(jointName(arm.joints[i]));
    drives_.push_back(std::make_unique<OutputPublishers>(joint, twin.drive(i)));
  }
}

void ArmPublishers::offer(MovingArm& arm) noexcept
{
  for (std::size_t i = 0; i < drives_.size(); ++i)
  {
    drives_[i]->offer(arm.twin().drive(i));
  }
  const Stamp stamp = arm.twin().stamp();
  if (stamp % period_ != 0)
  {
    return;
  }
  if (states_.isWanted())
  {
    states_.write(
        [&](sensor_msgs::JointState& message)
        {
          message.header.stamp = toRosTime(stamp);
          for (std::size_t k = 0; k < order_.size(); ++k)
          {
            const JointReading reading = arm.reading(order_[k]);
            message.position[k] = reading.position;
            message.velocity[k] = reading.velocity;
            message.effort[k] = reading.current;
          }
          return true;
        });
  }
  if (tool_.isWanted())
  {
    tool_.write([&](Pose& message) { return fillPose(stamp, arm.twin().toolPose(), message); });
  }
  if (wanted_tool_.isWanted())
  {
    arm.wanted(wanted_);
    wanted_tool_.write([&](Pose& message) { return fillPose(stamp, dynamics_.toolPose(wanted_), message); });
  }
}

Stamp ArmPublishers::finishCycle(Stamp instant) noexcept
{
  Stamp next = std::numeric_limits<Stamp>::max() / 2;
  for (const auto& drive : drives_)
  {
    next = std::min(next, drive->finishCycle(instant));
  }
  if (isHeard())
  {
    thread_.wakeUp();
    next = std::min(next, (instant / period_ + 1) * period_);
  }
  return next;
}

std::uint64_t ArmPublishers::dropped() const noexcept
{
  std::uint64_t sum = states_.counters("").dropped + tool_.counters("").dropped + wanted_tool_.counters("").dropped;
  for (const auto& drive : drives_)
  {
    for (const ChannelCounters& channel : drive->counters())
    {
      sum += channel.dropped;
    }
  }
  return sum;
}

bool ArmPublishers::isHeard() const noexcept
{
  return states_.isWanted() || tool_.isWanted() || wanted_tool_.isWanted();
}

void ArmPublishers::drain()
{
  states_.drain();
  tool_.drain();
  wanted_tool_.drain();
}

namespace
{
// Message definitions of ur_dashboard_msgs (github.com/UniversalRobots/Universal_Robots_ROS_Driver). The
// md5sums of the messages follow from these texts.
constexpr const char* ROBOT_MODE =
    "int8 NO_CONTROLLER=-1\nint8 DISCONNECTED=0\nint8 CONFIRM_SAFETY=1\nint8 BOOTING=2\n"
    "int8 POWER_OFF=3\nint8 POWER_ON=4\nint8 IDLE=5\nint8 BACKDRIVE=6\nint8 RUNNING=7\n"
    "int8 UPDATING_FIRMWARE=8\nint8 mode\n";
constexpr const char* ROBOT_MODE_SUM = "73b72d58742c4889c47118411b03a3b4";
constexpr std::uint8_t RUNNING = 7;
constexpr const char* SAFETY_MODE =
    "uint8 NORMAL=1\nuint8 REDUCED=2\nuint8 PROTECTIVE_STOP=3\nuint8 RECOVERY=4\nuint8 SAFEGUARD_STOP=5\n"
    "uint8 SYSTEM_EMERGENCY_STOP=6\nuint8 ROBOT_EMERGENCY_STOP=7\nuint8 VIOLATION=8\nuint8 FAULT=9\n"
    "uint8 VALIDATE_JOINT_ID=10\nuint8 UNDEFINED_SAFETY_MODE=11\nuint8 AUTOMATIC_MODE_SAFEGUARD_STOP=12\n"
    "uint8 SYSTEM_THREE_POSITION_ENABLING_STOP=13\nuint8 mode\n";
constexpr const char* SAFETY_MODE_SUM = "5da08725a63d4237bad689481131a84b";
constexpr std::uint8_t NORMAL = 1;
constexpr std::uint8_t PROTECTIVE_STOP = 3;

/// Message with a mode of the robot; the content is one byte.
topic_tools::ShapeShifter makeMode(const char* sum, const char* type, const char* definition, std::uint8_t mode)
{
  topic_tools::ShapeShifter message;
  message.morph(sum, std::string("ur_dashboard_msgs/") + type, definition, "1");
  ros::serialization::IStream stream(&mode, 1);
  message.read(stream);
  return message;
}

topic_tools::ShapeShifter makeRobotMode()
{
  return makeMode(ROBOT_MODE_SUM, "RobotMode", ROBOT_MODE, RUNNING);
}

topic_tools::ShapeShifter makeSafetyMode(bool protective_stop)
{
  return makeMode(SAFETY_MODE_SUM, "SafetyMode", SAFETY_MODE, protective_stop ? PROTECTIVE_STOP : NORMAL);
}

constexpr const char* WRENCH = "wrench";
constexpr const char* PAYLOAD = "payload";
constexpr const char* UNLOCK = "unlock_protective_stop";
/// Least time between two warnings of the same kind [s].
constexpr double ARM_WARNING_PERIOD = 1.0;
/// Time between two checks for a protective stop [s].
constexpr double STATE_PERIOD = 0.05;

/// Source of response surfaces for the drives. The function waits for the surfaces of the start, because full rings in
/// all drives would be too slow for the clock. Surfaces for later faults are built while the arm runs.
SurfaceSource armSurfaces(const std::vector<Parameters>& drives)
{
  SurfaceSource source = nodeSurfaceSource(false);
  source.pool = std::make_shared<SurfacePool>(2 * drives.size());
  for (const Parameters& drive : drives)
  {
    const Twin waits(drive, source);
  }
  source.background = !ros::Time::isSimTime();
  return source;
}

/// Parameters of the loop. The loop of an arm does not wait for an input.
Parameters loopParameters(Parameters drive)
{
  drive.input.wait_for_first_input = false;
  return drive;
}

std::array<double, 3> valuesOf(const geometry_msgs::Vector3& vector)
{
  return { vector.x, vector.y, vector.z };
}
}  // namespace

ArmDiagnostics::ArmDiagnostics(ros::NodeHandle& node, const ArmDescription& arm, const Parameters& parameters,
                               const RealtimeState& realtime, Read read)
  : arm_(arm)
  , read_(std::move(read))
  , failures_(arm.joints.size())
  , overloads_(arm.joints.size())
  , timing_(realtime, parameters.realtime.deadline)
  , tasks_(node.getNamespace().substr(1), parameters.joint.hardware_id)
{
  tasks_.add("Arm", this, &ArmDiagnostics::judge, &ArmDiagnostics::report);
  tasks_.add("Timing", &timing_, &TimingTask::judge, &TimingTask::report);
  timer_ = node.createWallTimer(ros::WallDuration(DiagnosticTasks::LOOK_PERIOD), [this](const auto&) { look(); });
}

void ArmDiagnostics::look()
{
  snapshot_ = read_();
  const ros::WallTime now = ros::WallTime::now();
  for (std::size_t i = 0; i < snapshot_.drives.size(); ++i)
  {
    failures_[i].update(snapshot_.drives[i].solver_failures, now);
    overloads_[i].update(snapshot_.drives[i].overloads, now);
  }
  timing_.update(snapshot_.loop, snapshot_.dropped);
  tasks_.look();
}

/// Names of the joints with recent events; empty if no joint has any.
std::string ArmDiagnostics::namesOf(const std::vector<RecentEvents>& events) const
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < events.size(); ++i)
  {
    if (events[i].areRecent())
    {
      names.push_back(arm_.joints[i].short_name);
    }
  }
  return joined(names);
}

DiagnosticVerdict ArmDiagnostics::judge() const
{
  using D = diagnostic_msgs::DiagnosticStatus;
  const std::string failed = namesOf(failures_);
  const std::string overloaded = namesOf(overloads_);
  return firstOf({ { !snapshot_.stop_reason.empty(), { D::ERROR, "Protective stop: " + snapshot_.stop_reason } },
                   { !failed.empty(), { D::ERROR, "The solver did not converge: " + failed } },
                   { !overloaded.empty(),
                     { D::WARN, "The torque exceeds output.torque_limit, so a step takes longer than its period: " +
                                    overloaded } } },
                 { D::OK, "Moves" });
}

void ArmDiagnostics::report(diagnostic_updater::DiagnosticStatusWrapper& status) const
{
  for (std::size_t i = 0; i < snapshot_.drives.size(); ++i)
  {
    const TwinCounters& drive = snapshot_.drives[i];
    const std::string& name = arm_.joints[i].short_name;
    status.add(name + ": steps beyond the joint's torque limit", drive.overloads);
    status.add(name + ": steps cut", drive.step_cuts);
    status.add(name + ": steps failed", drive.solver_failures);
  }
}

DriverStates::DriverStates(const ros::NodeHandle& parent)
  : parent_(parent)
  , robot_mode_(makeRobotMode().advertise(parent_, "ur_hardware_interface/robot_mode", 1, true))
  , safety_mode_(makeSafetyMode(false).advertise(parent_, "ur_hardware_interface/safety_mode", 1, true))
  , program_(parent_.advertise<std_msgs::Bool>("ur_hardware_interface/robot_program_running", 1, true))
  , speed_scaling_(parent_.advertise<std_msgs::Float64>("speed_scaling_factor", 1, true))
{
  robot_mode_.publish(makeRobotMode());
  show(false);
}

void DriverStates::show(bool protective_stop)
{
  if (shown_ == protective_stop)
  {
    return;
  }
  shown_ = protective_stop;
  safety_mode_.publish(makeSafetyMode(protective_stop));
  std_msgs::Bool program;
  program.data = !protective_stop;
  program_.publish(program);
  std_msgs::Float64 scaling;
  scaling.data = protective_stop ? 0.0 : 1.0;
  speed_scaling_.publish(scaling);
}

ArmNode::Advance::Advance(const ArmDescription& description, const std::vector<Parameters>& drives)
  : arm(description, drives, gentleMotion(description), armSurfaces(drives))
  , command({ gentleMotion(description), {} })
  , wrench(ArmWrench{})
  , payload(Payload{})
  , wanted_(drives.size())
  , counters_(drives.size())
  , watch_(description, arm.twin())
{
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    arm.twin().drive(i).watchSignals(true);
  }
  arm.wanted(wanted_);
  shown.tryWrite(wanted_);
  counters.tryWrite(counters_);
  report.tryWrite(watch_.report());
}

bool ArmNode::Advance::reset(Stamp stamp) noexcept
{
  watch_.forget();
  return arm.reset(stamp);
}

void ArmNode::Advance::push(const LiveInput& input) noexcept
{
  arm.twin().drive(input.joint).push(input.input);
}

bool ArmNode::Advance::step(Stamp until) noexcept
{
  command.take(
      [this](Command& given)
      {
        arm.follow(given.motion);
        watch_.begin(given.goal);
      });
  wrench.take([this](const ArmWrench& acting) { arm.twin().setWrench(acting); });
  payload.take([this](const Payload& carried) { arm.setPayload(carried); });
  if (unlock == Unlock::ASKED)
  {
    const bool is_done = arm.unlock();
    stop_reason = is_done ? nullptr : stop_reason.load();
    unlock = is_done ? Unlock::DONE : Unlock::MOVES;
  }
  if (!arm.step(until))
  {
    return false;
  }
  watch_.look(arm);
  return true;
}

void ArmNode::Advance::show(LoopStatus& /*status*/) noexcept
{
  arm.wanted(wanted_);
  shown.tryWrite(wanted_);
  for (std::size_t i = 0; i < counters_.size(); ++i)
  {
    counters_[i] = arm.twin().drive(i).counters();
  }
  counters.tryWrite(counters_);
  report.tryWrite(watch_.report());
  const std::optional<ProtectiveStop>& stop = arm.protectiveStop();
  stopped_joint = stop ? stop->joint : 0;
  stop_reason = stop ? stop->reason : nullptr;
}

ArmNode::ArmNode(ros::NodeHandle& node, const ArmDescription& arm, const std::vector<Parameters>& drives)
  : description_(arm)
  , advance_(arm, drives)
  , publishers_(node, arm, advance_.arm.twin())
  , loop_(
        advance_, loopParameters(drives.front()), inbox_, rosNow, rosClockKind(),
        [this] { publishers_.offer(advance_.arm); }, [this](Stamp instant) { return publishers_.finishCycle(instant); })
  , realtime_(requestRealtime(drives.front().realtime, loop_))
  , timing_publisher_(node, drives.front(), loop_)
  , diagnostics_(node, description_, drives.front(), realtime_,
                 [this] {
                   return ArmDiagnostics::Snapshot{ loop_.status(), advance_.counters.read(), stopReason(),
                                                    publishers_.dropped() };
                 })
  , limits_(arm, drives)
  , reset_service_(node.advertiseService("reset", &ArmNode::reset, this))
  , unlock_service_(node.advertiseService(UNLOCK, &ArmNode::unlock, this))
  , driver_states_(ros::NodeHandle())
  , stop_timer_(node.createWallTimer(ros::WallDuration(STATE_PERIOD), [this](const auto&) { tellOfStop(); }))
{
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    ros::NodeHandle joint(jointName(arm.joints[i]));
    faults_.push_back(
        std::make_unique<FaultSubscriber>(InputTopics{ joint, too_large_ }, advance_.arm.twin().drive(i), inbox_, i));
  }
  const InputTopics inputs{ node, too_large_ };
  command_subscriber_ = inputs.subscribe<trajectory_msgs::JointTrajectory>(
      topics::COMMAND, [this](const auto& event) { receiveCommand(*event.getMessage()); });
  wrench_subscriber_ = inputs.subscribe<geometry_msgs::WrenchStamped>(
      WRENCH, [this](const auto& event) { receiveWrench(*event.getMessage()); });
  payload_subscriber_ = inputs.subscribe<geometry_msgs::Inertia>(
      PAYLOAD, [this](const auto& event) { receivePayload(*event.getMessage()); });
  temperature_subscriber_ = inputs.subscribe<sensor_msgs::Temperature>(
      topics::JOINT_TEMPERATURES, [this](const auto& event) { receiveTemperature(*event.getMessage()); });
}

void ArmNode::tellOfStop()
{
  const std::string reason = stopReason();
  if (!reason.empty() && !told_of_stop_)
  {
    ROS_ERROR_STREAM("Protective stop: " << reason << "; the brakes hold the arm until ~" << UNLOCK << " or ~reset");
  }
  told_of_stop_ = !reason.empty();
  driver_states_.show(told_of_stop_);
}

std::string ArmNode::stopReason() const
{
  const char* reason = advance_.stop_reason;
  return reason == nullptr ? "" : description_.joints[advance_.stopped_joint].short_name + " is " + reason;
}

void ArmNode::receiveCommand(const trajectory_msgs::JointTrajectory& message)
{
  ArmGoal unwatched;
  if (const std::string errors = command(message, unwatched); !errors.empty())
  {
    ROS_WARN_STREAM_THROTTLE(ARM_WARNING_PERIOD, "Refused a trajectory on ~" << topics::COMMAND << ": " << errors);
  }
}

std::string ArmNode::command(const trajectory_msgs::JointTrajectory& message, ArmGoal& goal)
{
  if (advance_.stop_reason != nullptr)
  {
    return std::string("the arm is in a protective stop; ~") + UNLOCK + " ends the stop";
  }
  if (message.points.empty())
  {
    // All joints stop, whatever joints the message names, as in joint_trajectory_controller.
    give(stopFrom(advance_.shown.read()), goal);
    return "";
  }
  const Stamp now = rosNow();
  const Stamp ahead = std::max<Stamp>(stampOr(message.header.stamp, toRosTime(now)) - now, 0);
  std::vector<ArmSetPoint> points;
  std::string errors = ahead > FAR_STAMP ?
                           "its stamp is more than a day ahead of the clock" :
                           readTrajectory(message, description_, advance_.shown.read(), toSeconds(ahead), points);
  if (errors.empty())
  {
    const std::lock_guard<std::mutex> lock(command_mutex_);
    errors = limits_.errors(points);
  }
  if (errors.empty())
  {
    give(std::move(points), goal);
  }
  return errors;
}

void ArmNode::give(std::vector<ArmSetPoint> points, ArmGoal& goal)
{
  const std::lock_guard<std::mutex> lock(command_mutex_);
  goal.number = ++commands_;
  advance_.command.give({ ArmMotion(std::move(points), ArmAccelerations::OF_CUBICS), goal });
}

void ArmNode::receiveWrench(const geometry_msgs::WrenchStamped& message)
{
  constexpr double MOST = 1000.0;  // largest force [N] and moment [N.m]
  const ArmWrench wrench{ valuesOf(message.wrench.force), valuesOf(message.wrench.torque) };
  std::string errors;
  for (std::size_t axis = 0; axis < wrench.force.size(); ++axis)
  {
    for (const std::string& error : { rangeErrors("force", wrench.force[axis], "N", { -MOST, MOST }),
                                      rangeErrors("torque", wrench.moment[axis], "N.m", { -MOST, MOST }) })
    {
      errors = error.empty() ? errors : error;
    }
  }
  const std::string& frame = message.header.frame_id;
  if (!frame.empty() && frame != description_.base)
  {
    errors = "frame_id = '" + printable(frame) + "', allowed: '" + description_.base + "' or none";
  }
  if (!errors.empty())
  {
    ROS_WARN_STREAM_THROTTLE(ARM_WARNING_PERIOD, "Refused a wrench on ~" << WRENCH << ": " << errors);
    return;
  }
  advance_.wrench.give(wrench);
}

void ArmNode::receivePayload(const geometry_msgs::Inertia& message)
{
  const Payload payload{ message.m, valuesOf(message.com) };
  const std::string errors = payloadErrors(payload);
  if (!errors.empty())
  {
    ROS_WARN_STREAM_THROTTLE(ARM_WARNING_PERIOD, "Refused a payload on ~" << PAYLOAD << ": " << errors);
    return;
  }
  const std::lock_guard<std::mutex> lock(command_mutex_);
  limits_.setPayload(payload);
  advance_.payload.give(payload);
}

void ArmNode::receiveTemperature(const sensor_msgs::Temperature& message)
{
  const auto joint = std::find_if(description_.joints.begin(), description_.joints.end(),
                                  [&](const ArmJoint& each) { return each.name == message.header.frame_id; });
  if (joint == description_.joints.end())
  {
    ROS_INFO_STREAM_ONCE("Ignored a message on ~" << topics::JOINT_TEMPERATURES << ": frame_id = '"
                                                  << printable(message.header.frame_id)
                                                  << "' is not a joint of this arm");
    return;
  }
  if (const Range range{ MIN_TEMPERATURE, MAX_TEMPERATURE }; !isWithin(message.temperature, range))
  {
    ROS_WARN_STREAM_THROTTLE(ARM_WARNING_PERIOD,
                             "Refused a temperature on ~"
                                 << topics::JOINT_TEMPERATURES << ": "
                                 << outOfRangeText("temperature", message.temperature, "degC", range));
    return;
  }
  const Stamp stamp = stampOr(message.header.stamp, ros::Time::now());
  inbox_.push(Input{ stamp, InputKind::TEMPERATURE, message.temperature },
              static_cast<std::size_t>(joint - description_.joints.begin()));
}

bool ArmNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  response.success = loop_.reset();
  response.message = response.success ? "the arm restarts where it began" : "the loop of the arm does not respond";
  return true;
}

bool ArmNode::unlock(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  constexpr int LOOKS = 200;
  const ros::WallDuration period(0.005);
  advance_.unlock = Unlock::ASKED;
  for (int look = 0; advance_.unlock == Unlock::ASKED && look < LOOKS; ++look)
  {
    period.sleep();
  }
  const Unlock answer = advance_.unlock.exchange(Unlock::NOT_ASKED);
  response.success = answer == Unlock::DONE;
  response.message = answer == Unlock::DONE  ? "the arm holds its present position" :
                     answer == Unlock::MOVES ? "the arm is still moving" :
                                               "the loop of the arm does not respond";
  return true;
}
}  // namespace hjt
