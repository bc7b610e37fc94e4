// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include <ros/subscriber.h>

#include "harmonic_joint_twin/Fault.h"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "live/inbox.hpp"
#include "ros_io/input_topics.hpp"

namespace hjt
{
/// Puts the faults that come on ~inject_fault into the inbox; one that is not valid is refused, with a warning.
class FaultSubscriber
{
public:
  /// `twin`: whose faults they are; `joint`: its number in the inbox.
  FaultSubscriber(const InputTopics& inputs, const Twin& twin, Inbox& inbox, std::size_t joint = 0);

  std::uint64_t refused() const noexcept { return refused_; }  ///< since start

private:
  void receive(const harmonic_joint_twin::Fault& message);

  const Twin& twin_;
  Inbox& inbox_;
  const std::size_t joint_;
  std::atomic<std::uint64_t> refused_{ 0 };
  ros::Subscriber subscriber_;
};
}  // namespace hjt
