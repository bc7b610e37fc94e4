// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/arm_node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <ros/console.h>

#include "base/printable.hpp"
#include "base/range_check.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "ros_io/arm_trajectory.hpp"
#include "ros_io/input_topics.hpp"
#include "ros_io/joint_name.hpp"
#include "ros_io/live_loop.hpp"
#include "ros_io/node_surface_source.hpp"
#include "surface/surface_pool.hpp"

namespace hjt
{
namespace
{
constexpr const char* WRENCH = "wrench";
constexpr const char* PAYLOAD = "payload";
constexpr const char* UNLOCK = "unlock_protective_stop";
/// Between two warnings of the same kind [s].
constexpr double ARM_WARNING_PERIOD = 1.0;
/// Between two looks at a protective stop [s].
constexpr double STATE_PERIOD = 0.05;

/// Those of the drives as they start are waited for: so many rings would not keep up with the clock. Those of faults
/// that come later are built beside the running arm.
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

/// The loop does not wait for torques of others.
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
    ROS_ERROR_STREAM("Protective stop: " << reason << "; the arm stands in its brakes until ~" << UNLOCK
                                         << " or ~reset");
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
    return std::string("protective stop; ~") + UNLOCK + " ends it";
  }
  if (message.points.empty())
  {
    // As joint_trajectory_controller does, whichever joints it names.
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
  constexpr double MOST = 1000.0;  // [N], [N.m]
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
    ROS_INFO_STREAM_ONCE("Left alone on ~" << topics::JOINT_TEMPERATURES << ": frame_id = '"
                                           << printable(message.header.frame_id) << "' is no joint of this arm");
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
  response.message = response.success ? "the arm restarts where it began" : "the loop does not answer";
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
  response.message = answer == Unlock::DONE  ? "the arm is held where it stands" :
                     answer == Unlock::MOVES ? "the arm still moves" :
                                               "the loop does not answer";
  return true;
}
}  // namespace hjt
