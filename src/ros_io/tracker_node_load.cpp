// SPDX-License-Identifier: BSD-3-Clause
// Payload and mounting that an arm's currents show, and whether it is another arm.
#include "ros_io/tracker_node.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <ros/console.h>

#include "base/date_text.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
/// Period of the check of the telemetry [s].
constexpr double FIT_PERIOD = 1.0;
}  // namespace

/// Other rows follow.
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

/// What fits and what does not, of the rows so far.
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

/// The rows that the ranking of arms is made of.
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

/// By the law of `joint_twin compare`. Its answer counts when it comes, whether rows still come or not.
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
    ROS_WARN_STREAM((arm_->other().empty() ? "No other arm explains the currents clearly better any more" :
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
  catch (const std::exception& error)  // files of the arms, or no thread
  {
    ROS_WARN_STREAM("Whether the arm is another is not looked at: " << error.what());
    arm_.reset();
  }
}

/// When the payload became another; empty: it is the one of all rows.
std::string TrackerNode::sinceText(double since) const
{
  return std::isinf(since) ? "" : "; since " + dateText(stream_.clock.stamp(since), "%H:%M:%S") + " UTC";
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

/// Uses the load that the currents show in place of the configured one, by the test of `joint_twin compare`.
void TrackerNode::lookAtLoad()
{
  if (!load_ || !load_->isDue())
  {
    return;
  }
  const bool was_trying = load_->isTrying();
  const bool is_other = load_->look(judgedJoints());
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
    ROS_INFO_STREAM((load_->isTrying() ? "Another load than configured is tried: no WARN until it is known to fit" :
                     !std::isinf(assumed.since) ? "The payload changed: the joints start again" :
                     assumed.isConfigured()     ? "The configured load counts again" :
                                                  "The load that stood before counts again"));
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
                    << "The joints are judged with it");
  }
}
}  // namespace hjt
