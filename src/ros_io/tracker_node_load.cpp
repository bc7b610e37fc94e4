// SPDX-License-Identifier: BSD-3-Clause
// Payload and mounting that an arm's currents show.
#include "ros_io/tracker_node.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <ros/console.h>

namespace hjt
{
void TrackerNode::addToLoad(const ArmSample& sample)
{
  load_->add(sample, std::any_of(joints_.begin(), joints_.end(), [](const auto& joint) { return joint->isTouched(); }));
}

JudgedJoints TrackerNode::judgedJoints() const
{
  std::vector<MeasuredFriction> frictions;
  for (const auto& joint : joints_)
  {
    frictions.push_back(joint->verdict().measuredFriction());
  }
  JudgedJoints judged(*fit_, fit_->whyNotJudged(), std::move(frictions), repeat_tolerance_);
  if (friction_->found().temperature)
  {
    judged.common.median = friction_->found().median;  // the twins are predicted with it
  }
  return judged;
}

/// What the currents show of the load counts in place of the configured one, by the law of `joint_twin compare`.
void TrackerNode::lookAtLoad()
{
  if (!load_ || !load_->isDue())
  {
    return;
  }
  const bool was_trying = load_->isTrying();
  const bool is_other = load_->look(judgedJoints());
  const AssumedLoad& assumed = load_->assumed();
  stream_.mounting = assumed.mounting && !load_->isTrying() ? assumed.mounting->text() : "";
  stream_.payload = assumed.payload && !load_->isTrying() ? assumed.payload->text() : "";
  if (is_other)
  {
    ROS_INFO_STREAM((load_->isTrying() ? "Another load than configured is tried: no WARN until it is known to fit" :
                     assumed.isConfigured() ? "The configured load counts again" :
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
    ROS_WARN_STREAM(assumed.text());
  }
}
}  // namespace hjt
