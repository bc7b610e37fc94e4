// SPDX-License-Identifier: BSD-3-Clause
// Payload and mounting that an arm's currents show.
#include "ros_io/tracker_node.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include <ros/console.h>

#include "tracking/verdict.hpp"

namespace hjt
{
void TrackerNode::addToLoad(const ArmSample& sample)
{
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    load_->setMeasured(i, joints_[i]->hasEffort());
  }
  load_->add(sample, std::any_of(joints_.begin(), joints_.end(), [](const auto& joint) { return joint->isTouched(); }));
}

/// What the currents show of the load and is not configured counts from now on, as `joint_twin compare` judges a
/// recording.
void TrackerNode::lookAtLoad()
{
  const std::optional<FoundLoad> found = load_ ? load_->look() : std::nullopt;
  if (!found)
  {
    return;
  }
  const std::optional<IdentifiedMounting> mounting = load_->mountingOf(*found);
  if (!mounting)
  {
    lookAtPayload(*found);
    return;
  }
  stream_.mounting = mounting->differs() ? mounting->text() : std::string();
  ROS_WARN_STREAM((mounting->differs() ? sentence(stream_.mounting) : "The arm is mounted as configured.")
                  << " The joints are judged with it from now on");
  load_->mount(mounting->gravity);
  startWithLoad();
}

/// A payload explains no telemetry that does not fit, nor an arm led by hand. Once it is put down the configured one
/// counts again.
void TrackerNode::lookAtPayload(const FoundLoad& found)
{
  const std::optional<IdentifiedPayload> payload = load_->payloadOf(found);
  if (!payload || !std::all_of(joints_.begin(), joints_.end(), [](const auto& of) { return of->mayCarryOther(); }))
  {
    return;
  }
  stream_.payload = payload->isCarried() ? payload->text() : "";
  if (payload->isCarried())
  {
    ROS_WARN_STREAM(sentence(stream_.payload) << " The joints are judged with it from now on");
    load_->configure(payload->payload());
  }
  else
  {
    ROS_INFO_STREAM("The payload that is not configured is put down: the configured one counts from now on");
    load_->configure(load_->given());
  }
  startWithLoad();
}

void TrackerNode::startWithLoad()
{
  arm_load_.emplace(load_->arm());
  resetFit();
  for (const auto& joint : joints_)
  {
    joint->start(true);
  }
}
}  // namespace hjt
