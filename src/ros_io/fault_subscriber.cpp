// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/fault_subscriber.hpp"

#include <string>
#include <vector>

#include <ros/console.h>

#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"

namespace hjt
{
FaultSubscriber::FaultSubscriber(const InputTopics& inputs, const Twin& twin, Inbox& inbox, std::size_t joint)
  : twin_(twin)
  , inbox_(inbox)
  , joint_(joint)
  , subscriber_(inputs.subscribe<harmonic_joint_twin::Fault>(
        topics::INJECT_FAULT, [this](const auto& event) { receive(*event.getMessage()); }))
{
}

void FaultSubscriber::receive(const harmonic_joint_twin::Fault& message)
{
  // Faults come one by one, and each warning has a reason of its own [s].
  constexpr double WARNING_PERIOD = 1.0;
  std::vector<Fault> steps;
  const std::string errors = readFault(message, twin_.parameters(), steps);
  if (!errors.empty())
  {
    ++refused_;
    ROS_WARN_STREAM_THROTTLE(
        WARNING_PERIOD, "Refused a message on ~" << topics::INJECT_FAULT << ", " << refused_ << " so far: " << errors);
    return;
  }
  const Stamp stamp = stampOr(message.header.stamp, ros::Time::now());
  for (const Fault& fault : steps)
  {
    inbox_.push(StampedFault{ stamp, fault }, joint_);
  }
}
}  // namespace hjt
