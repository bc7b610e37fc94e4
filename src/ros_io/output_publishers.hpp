// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include <ros/node_handle.h>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "ros_io/output_channel.hpp"

namespace hjt
{
/// Everything the twin publishes. The loop fills the messages that are due and have subscribers; serialising and
/// sending, which allocate and
/// lock, happen in a thread of their own.
class OutputPublishers
{
public:
  OutputPublishers(ros::NodeHandle& node, const Twin& twin);

  /// Stops the thread after the messages already filled.
  ~OutputPublishers();

  /// Loop: fills the messages due at the twin's current instant that somebody hears. No allocation, no lock.
  void offer(Twin& twin) noexcept;

  /// Loop: the next instant after this one whose messages somebody hears [ns].
  Stamp nextHeard(Stamp instant) const noexcept { return outputs_.nextDue(instant); }

  /// The faults published last, for a human reader.
  std::string activeFaults() const;

  /// In the order of CHANNELS.
  std::array<ChannelCounters, CHANNEL_COUNT> counters() const noexcept;

private:
  struct FaultsAt
  {
    Stamp stamp;
    FaultList faults;
  };
  void offerFaults(const Twin& twin) noexcept;
  void drainFaults();
  void run();

  Outputs<OutputChannel> outputs_;
  const JointNames names_;
  SlotRing<FaultsAt> faults_;
  ros::Publisher faults_publisher_;
  std::uint64_t offered_faults_;  // version of the list that was offered last
  std::atomic<bool> stopping_{ false };
  mutable std::mutex text_mutex_;
  std::string active_faults_;
  std::thread thread_;
};
}  // namespace hjt
