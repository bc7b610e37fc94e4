// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <ros/console.h>
#include <ros/subscriber.h>

#include "harmonic_joint_twin/Fault.h"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "live/inbox.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "ros_io/input_topics.hpp"

namespace hjt
{
/// Puts the faults that come on ~inject_fault into the inbox; one that is not valid is refused, with a warning.
class FaultSubscriber
{
public:
  /// `twin`: whose faults they are; `joint`: its number in the inbox.
  FaultSubscriber(const InputTopics& inputs, const Twin& twin, Inbox& inbox, std::size_t joint = 0)
    : twin_(twin)
    , inbox_(inbox)
    , joint_(joint)
    , subscriber_(inputs.subscribe<harmonic_joint_twin::Fault>(
          topics::INJECT_FAULT, [this](const auto& event) { receive(*event.getMessage()); }))
  {
  }

  std::uint64_t refused() const noexcept { return refused_; }  ///< since start

private:
  void receive(const harmonic_joint_twin::Fault& message)
  {
    // Faults come one by one, and each warning has a reason of its own [s].
    constexpr double WARNING_PERIOD = 1.0;
    std::vector<Fault> steps;
    const std::string errors = readFault(message, twin_.parameters(), steps);
    if (!errors.empty())
    {
      ++refused_;
      ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "Refused a message on ~" << topics::INJECT_FAULT << ", " << refused_
                                                                        << " so far: " << errors);
      return;
    }
    const Stamp stamp = stampOr(message.header.stamp, ros::Time::now());
    for (const Fault& fault : steps)
    {
      inbox_.push(StampedFault{ stamp, fault }, joint_);
    }
  }

  const Twin& twin_;
  Inbox& inbox_;
  const std::size_t joint_;
  std::atomic<std::uint64_t> refused_{ 0 };
  ros::Subscriber subscriber_;
};
}  // namespace hjt
