// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/tracker_node.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <ros/console.h>
#include <ros/master.h>
#include <ros/message_traits.h>
#include <ros/this_node.h>

#include "base/text.hpp"
#include "messages/joint_affixes.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "ros_io/input_subscribers.hpp"
#include "ros_io/node_environment.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
/// Time between two verdicts on the joints [s].
constexpr double VERDICT_PERIOD = 1.0;
/// Time after the start at which the node warns if no message has arrived [s].
constexpr double MESSAGE_PATIENCE = 10.0;
/// Largest length at which the node shows the names in a message [bytes].
constexpr std::size_t MAX_NAMES = 500;

/// Topics on which JointState messages are published. Empty if there are none, or if the master does not respond.
std::vector<std::string> publishedJointStates()
{
  XmlRpc::XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  arguments[1] = "";
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue published;
  std::vector<std::string> names;
  if (ros::master::execute("getPublishedTopics", arguments, response, published, false) &&
      published.getType() == XmlRpc::XmlRpcValue::TypeArray)
  {
    for (int i = 0; i < published.size(); ++i)
    {
      if (std::string(published[i][1]) == ros::message_traits::datatype<sensor_msgs::JointState>())
      {
        names.push_back(published[i][0]);
      }
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Time between two checks of the telemetry [s].
constexpr double FIT_PERIOD = 1.0;
}  // namespace

TrackerNode::TrackerNode(ros::NodeHandle& node, const Parameters& parameters)
  : repeat_tolerance_(parameters.comparison.repeat_tolerance)
{
  addJoint(node, parameters, SoundJoint(), false);
  subscribe(node);
}

TrackerNode::TrackerNode(ros::NodeHandle& node, const Arm& arm)
  : arm_load_(arm.description), fit_(arm.joints), repeat_tolerance_(arm.joints.front().comparison.repeat_tolerance)
{
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    addJoint(ros::NodeHandle(jointName(arm.description.joints[i])), arm.joints[i], arm.sound[i], arm.is_identified);
  }
  if (std::all_of(joints_.begin(), joints_.end(), [](const auto& joint) { return joint->takesArmLoad(); }))
  {
    std::vector<LoadFit::Drive> drives(arm.joints.begin(), arm.joints.end());
    for (std::size_t i = 0; i < drives.size(); ++i)
    {
      const std::vector<FrictionPoint>& own = arm.sound[i].own.friction;
      drives[i].setOwn(arm.is_identified || !own.empty(), own);
    }
    load_.emplace(arm.description, arm.joints, std::move(drives));
    if (arm.candidates)
    {
      arm_.emplace(arm.candidates, arm.name, arm.unit_is_given);
    }
  }
  subscribe(node);
}

void TrackerNode::addJoint(ros::NodeHandle node, const Parameters& parameters, const SoundJoint& sound,
                           bool is_identified)
{
  joints_.push_back(std::make_unique<JointTracker>(node, parameters, sound, is_identified, stream_, mutex_));
  rows_.emplace_back();
  angles_.emplace_back();
}

void TrackerNode::subscribe(ros::NodeHandle& node)
{
  std::vector<double> speeds;
  for (const auto& joint : joints_)
  {
    speeds.push_back(joint->greatestSpeed());
  }
  filter_.emplace(std::move(speeds));
  timer_ = node.createWallTimer(ros::WallDuration(DiagnosticTasks::LOOK_PERIOD),
                                [this](const ros::WallTimerEvent&) { look(); });
  patience_ = node.createWallTimer(
      ros::WallDuration(MESSAGE_PATIENCE), [this](const ros::WallTimerEvent&) { missTelemetry(); }, true);
  const InputTopics inputs{ node, stream_.too_large };
  stream_.topic = node.resolveName(topics::MEASURED);
  telemetry_subscriber_ = inputs.subscribe<sensor_msgs::JointState>(
      topics::MEASURED, [this](const JointStateEvent& event) { receiveTelemetry(event); });
  load_subscriber_ = inputs.subscribe<sensor_msgs::JointState>(
      topics::LOAD, [this](const JointStateEvent& event) { receiveLoad(event); });
  temperature_subscriber_ = inputs.subscribe<sensor_msgs::Temperature>(
      topics::JOINT_TEMPERATURES, [this](const auto& event) { receiveTemperature(event); });
}

/// Clause: why the message contains no row.
std::string TrackerNode::lackOf(const sensor_msgs::JointState& message) const
{
  std::vector<std::string> names;
  for (const auto& joint : joints_)
  {
    names.push_back(joint->joint());
  }
  const std::string unnamed = lackText(names, message.name);
  if (!unnamed.empty())
  {
    return printable(unnamed, MAX_NAMES) + (joints_.size() > 1 ? "; each message must contain all of them" : "");
  }
  const std::size_t size = message.name.size();
  return "their " + std::string(message.position.size() < size ?
                                    "position is empty or too short" :
                                message.effort.size() < size ?
                                    "effort is empty or too short; it must contain the motors' currents" :
                                    "position or effort is not finite (NaN)");
}

/// Whether the efforts of all joints of an arm are exactly zero, which no measurement gives.
bool TrackerNode::isWithoutEffort() const
{
  return rows_.size() > 1 &&
         std::all_of(rows_.begin(), rows_.end(), [](const MotionRow& row) { return row.current == 0.0; });
}

void TrackerNode::receiveTelemetry(const JointStateEvent& event)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const sensor_msgs::JointState& message = *event.getMessage();
  std::size_t found = 0;
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    const TelemetryStatus status = joints_[i]->read(message, rows_[i]);
    found += status == TelemetryStatus::FOUND ? 1 : 0;
    unknown += status == TelemetryStatus::UNKNOWN_JOINT ? 1 : 0;
  }
  if (unknown > 0)
  {
    stream_.found_names = printable(joined(message.name), MAX_NAMES);
  }
  // Other devices may publish on this topic. A message of a gripper, for example, must not cause a warning.
  if (unknown > 0 && (unknown < joints_.size() || !stream_.clock.hasStarted()))
  {
    ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "Messages on " << stream_.topic << " lack " << unknown << " of "
                                                            << joints_.size() << " joints; they name "
                                                            << stream_.found_names);
  }
  if (found < joints_.size())
  {
    stream_.lack = lackOf(message);
    return;
  }
  if (has_efforts_ && isWithoutEffort())
  {
    ++stream_.without_effort;
    return;
  }
  has_efforts_ = has_efforts_ || !isWithoutEffort();
  stream_.lack.clear();
  const Stamp stamp = stampOr(message.header.stamp, event.getReceiptTime());
  stream_.last_received = fromRosTime(event.getReceiptTime());
  push(stamp);
}

/// Passes on the rows of the present message: to the joints, and to the checks of the arm.
void TrackerNode::push(Stamp stamp)
{
  const TelemetryClock::Row taken = stream_.clock.take(stamp, stream_.last_received);
  if (taken == TelemetryClock::Row::REFUSED)
  {
    ++stream_.far_stamps;
    return;
  }
  const double time = stream_.clock.seconds(stamp);
  const bool moved = taken == TelemetryClock::Row::MOVED;
  stream_.clock_changes += moved ? 1 : 0;
  if (moved)
  {
    stream_.timing.reset();
  }
  if (moved || time < last_time_ - StreamTiming::RESTART)
  {
    restart();
    filter_->reset();
  }
  if (moved && arm_load_)
  {
    arm_load_->reset();
  }
  last_time_ = time;
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    if (taken != TelemetryClock::Row::TAKEN)
    {
      joints_[i]->start(moved);
      angles_[i].reset();
    }
    const std::uint64_t folds = angles_[i].folds();
    rows_[i].position = angles_[i].take(time, rows_[i].position);
    stream_.folds += angles_[i].folds() - folds;
    rows_[i].time = time;
    rows_[i].received = stream_.clock.seconds(stream_.last_received);
  }
  if (stream_.folds > 0)
  {
    ROS_WARN_STREAM_ONCE("Angles on " << stream_.topic
                                      << " are folded into one turn; the node removes their jumps by 2 pi");
  }
  stream_.timing.add(time, rows_.front().received);
  filter_->push(rows_,
                [this](const std::vector<MotionRow>& rows)
                {
                  follow(rows);
                  return true;
                });
  stream_.left_out = filter_->leftOut();
}

void TrackerNode::follow(const std::vector<MotionRow>& rows)
{
  if (!arm_load_)
  {
    joints_.front()->push(rows.front());
    return;
  }
  arm_load_->push(rows);
  while (const ArmSample* sample = arm_load_->pop())
  {
    take(*sample);
  }
  lookAtLoad();
  watchArm(rows);
}

void TrackerNode::take(const ArmSample& sample)
{
  updateFit(sample);
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    if (joints_[i]->takesArmLoad())
    {
      joints_[i]->pushLoad(sample.own[i].time, sample.torques[i]);
    }
    joints_[i]->compare(sample.own[i]);
  }
  if (load_)
  {
    load_->add(sample);
  }
}

void TrackerNode::resetFit()
{
  if (fit_)
  {
    fit_->reset();
    next_fit_ = -HUGE_VAL;
    for (const auto& joint : joints_)
    {
      joint->tracker().setTemperature(std::nullopt);
      joint->setArmFriction(1.0);
    }
  }
}

void TrackerNode::receiveLoad(const JointStateEvent& event)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& joint : joints_)
  {
    joint->receiveLoad(*event.getMessage(), fromRosTime(event.getReceiptTime()));
  }
}

void TrackerNode::receiveTemperature(const ros::MessageEvent<const sensor_msgs::Temperature>& event)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const sensor_msgs::Temperature& message = *event.getMessage();
  bool is_of_joint = false;
  for (const auto& joint : joints_)
  {
    if (joint->joint() == message.header.frame_id)
    {
      joint->receiveTemperature(message, fromRosTime(event.getReceiptTime()));
      is_of_joint = true;
    }
  }
  stream_.other_temperatures += is_of_joint ? 0 : 1;
}

/// Judges each joint by its friction without the common factor, as `joint_twin compare` does with a recording.
void TrackerNode::judge(const ros::WallTime& now)
{
  if (now < next_verdict_)
  {
    return;
  }
  next_verdict_ = now + ros::WallDuration(VERDICT_PERIOD);
  std::vector<VerdictWatch*> verdicts;
  for (const auto& joint : joints_)
  {
    verdicts.push_back(&joint->verdict());
  }
  const ArmFriction found = judgeTogether(verdicts, repeat_tolerance_);
  for (std::size_t i = 0; i < joints_.size() && found.is_known; ++i)
  {
    verdicts[i]->predictAt(found);
    joints_[i]->setArmFriction(found.temperature ? 1.0 : found.factors[i]);
  }
}

void TrackerNode::look()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::WallTime now = ros::WallTime::now();
  lookAtArm();
  lookAtLoad();
  judge(now);
  for (const auto& joint : joints_)
  {
    joint->look(now);
  }
}

void TrackerNode::missTelemetry()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stream_.clock.hasStarted() || !stream_.lack.empty() || stream_.too_large > 0)
    {
      return;
    }
  }
  std::vector<std::string> others = publishedJointStates();
  const auto own = std::find(others.begin(), others.end(), stream_.topic);
  const bool is_announced = own != others.end();
  if (is_announced)
  {
    others.erase(own);
  }
  ROS_WARN_STREAM(
      "No message on " << stream_.topic << " yet. "
                       << (is_announced   ? "A publisher of this topic exists but sends no messages" :
                           others.empty() ? "No node publishes a JointState; check whether the driver runs" :
                                            "A JointState is published on " + printable(joined(others), MAX_NAMES) +
                                                "; select this topic with measured:="));
}

/// Forgets all rows, because the next rows have stamps of another clock than the rows before.
void TrackerNode::restart()
{
  resetFit();
  if (load_)
  {
    load_->reset();
    for (const auto& joint : joints_)
    {
      joint->setFitted({});
    }
  }
  if (arm_)
  {
    arm_->reset();
  }
}

void TrackerNode::updateFit(const ArmSample& sample)
{
  fit_->update(sample.joints, sample.torques);
  const double time = sample.joints.front().time;
  if (time < next_fit_)
  {
    return;
  }
  next_fit_ = time + FIT_PERIOD;
  lookAtFit();
}

/// Checks by RecordingFit whether angles, velocities, stamps and currents fit together. Gives each joint its misfit.
void TrackerNode::lookAtFit()
{
  const bool settled = fit_->isSettled() && (!load_ || load_->isSettled()) && (!arm_ || arm_->isSettled());
  std::vector<Misfit> misfits = fit_->whyNotJudged();
  if (arm_ && !arm_->other().empty())
  {
    nameOtherArm(arm_->other(), misfits);
  }
  if (load_)
  {
    addMisfit(load_->misfit(), misfits);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    joints_[i]->setMisfit(misfits[i], settled);
  }
}

/// Adds the rows of all joints to the ranking of arm types, which checks whether the arm has the configured type.
void TrackerNode::watchArm(const std::vector<MotionRow>& rows)
{
  if (!arm_)
  {
    return;
  }
  efforts_ = rows;
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    efforts_[i].current /= joints_[i]->currentPerEffort();
  }
  tryOnArm([this] { arm_->add(efforts_); });
}

/// Takes the result of the ranking of arm types, even without new rows. The ranking follows `joint_twin compare`.
void TrackerNode::lookAtArm()
{
  if (!arm_)
  {
    return;
  }
  const std::string before = arm_->other();
  bool is_answered = false;
  tryOnArm([&] { is_answered = arm_->look(); });
  if (arm_ && !is_answered)
  {
    return;
  }
  if (arm_ && arm_->other() != before)
  {
    ROS_WARN_STREAM((arm_->other().empty() ? "The currents no longer fit another arm clearly better than this one" :
                                             "Not judged: " + otherArmText(arm_->other())));
  }
  lookAtFit();
}

void TrackerNode::tryOnArm(const std::function<void()>& act)
{
  try
  {
    act();
  }
  catch (const std::exception& error)  // a file of an arm is unreadable, or the system allows no thread
  {
    ROS_WARN_STREAM("The check for another type of arm failed: " << error.what());
    arm_.reset();
  }
}

/// Text with the time at which the payload changed; empty if the payload is equal in all rows.
std::string TrackerNode::sinceText(double since) const
{
  return std::isinf(since) ?
             "" :
             ". The arm has had this load since " + dateText(stream_.clock.stamp(since), "%H:%M:%S") + " UTC";
}

JudgedJoints TrackerNode::judgedJoints() const
{
  std::vector<MeasuredFriction> frictions;
  for (const auto& joint : joints_)
  {
    frictions.push_back(joint->verdict().measuredFriction());
  }
  return { *fit_, fit_->whyNotJudged(), std::move(frictions), repeat_tolerance_ };
}

/// Tests by the rule of `joint_twin compare` whether the currents show another load than the configured one. If so, the
/// node uses the load that the currents show.
void TrackerNode::lookAtLoad()
{
  if (!load_ || !load_->isDue())
  {
    return;
  }
  const bool was_trying = load_->isTrying();
  const bool is_other = load_->look(judgedJoints());
  if (load_->isLooking())
  {
    return;
  }
  for (std::size_t i = 0; i < load_->frictions().size(); ++i)
  {
    joints_[i]->setFitted(load_->frictions()[i]);
  }
  const AssumedLoad& assumed = load_->assumed();
  if (is_other || was_trying)
  {
    stream_.mounting = assumed.mounting && !load_->isTrying() ? assumed.mounting->text() : "";
    stream_.drag = assumed.drag && !load_->isTrying() ? assumed.drag->text() : "";
    stream_.payload = assumed.payload && !load_->isTrying() ? assumed.payload->text() + sinceText(assumed.since) : "";
  }
  if (is_other)
  {
    ROS_INFO_STREAM(
        (load_->isTrying() ?
             "The twin tests a load that differs from the configured one; no WARN is given during the test" :
         !std::isinf(assumed.since) ? "The payload has changed; the joints are judged from the change on" :
         assumed.isConfigured()     ? "The twin uses the configured load again" :
                                      "The twin again uses the load from before the test"));
    arm_load_.emplace(load_->arm());
    resetFit();
    for (const auto& joint : joints_)
    {
      joint->start(true);
    }
  }
  else if (was_trying)
  {
    ROS_WARN_STREAM((stream_.mounting.empty() ? "" : sentence(stream_.mounting) + " ")
                    << (stream_.drag.empty() ? "" : sentence(stream_.drag) + " ")
                    << (stream_.payload.empty() ? "" : sentence(stream_.payload) + " ")
                    << "The joints are judged with this load");
  }
  lookAtFit();
}
}  // namespace hjt
