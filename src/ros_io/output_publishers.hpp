// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <mutex>
#include <string>

#include <ros/node_handle.h>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "ros_io/output_channel.hpp"
#include "ros_io/publisher_thread.hpp"

namespace hjt
{
/// Everything the twin publishes. The loop fills the messages that are due and have subscribers; a thread sends them.
class OutputPublishers
{
public:
  OutputPublishers(ros::NodeHandle& node, const Twin& twin);

  /// Loop: fills the messages due at the twin's current instant that somebody hears. No allocation, no lock.
  void offer(Twin& twin) noexcept;

  /// Loop: has the messages filled since the last call sent. Returns the next instant after this one whose messages
  /// somebody hears [ns]. No allocation, no lock that anybody holds for long.
  Stamp finishCycle(Stamp instant) noexcept;

  /// The faults published last, for a human reader.
  std::string activeFaults() const;

  /// Counters of the channels, in the order of CHANNELS.
  std::array<ChannelCounters, CHANNEL_COUNT> counters() const noexcept;

private:
  struct FaultsAt
  {
    Stamp stamp;
    FaultList faults;
  };
  void offerFaults(const Twin& twin) noexcept;
  void drainFaults();
  bool isHeard() const noexcept;

  Outputs<OutputChannel> outputs_;
  const JointNames names_;
  SlotRing<FaultsAt> faults_;
  ros::Publisher faults_publisher_;
  std::uint64_t offered_faults_;  // version of the list that was offered last
  mutable std::mutex text_mutex_;
  std::string active_faults_;
  PublisherThread thread_;  // last: it uses the rest
};
}  // namespace hjt
