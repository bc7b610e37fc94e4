// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "base/text_stream.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "live/slot_ring.hpp"
#include "messages/channels.hpp"
#include "ros_io/publisher_thread.hpp"

namespace hjt
{
struct ChannelCounters
{
  const char* name{};
  std::uint64_t computed{};  ///< messages filled since start
  std::uint64_t dropped{};   ///< messages due but not filled: the publisher had fallen behind by the whole ring
};

/// Sink of a live topic: filled by the loop into preallocated slots, published by another thread.
template <class Message>
class OutputChannel
{
public:
  OutputChannel(ros::NodeHandle* node, const Channel<Message>& channel, const Message& first)
    : ring_(channel.slots, first)
  {
    const auto count = [this](int by)
    { return [this, by](const ros::SingleSubscriberPublisher&) { subscribers_ += by; }; };
    publisher_ = node->advertise<Message>(channel.name, static_cast<std::uint32_t>(channel.slots), count(1), count(-1));
  }

  /// Whether anybody listens.
  bool isWanted() const noexcept { return subscribers_.load(std::memory_order_relaxed) > 0; }

  /// Loop: lets `fill(Message&)` write the next message, unless it returns false. A full ring drops it and counts.
  template <class Fill>
  void write(Fill&& fill) noexcept
  {
    Message* message = ring_.claim();
    if (message == nullptr)
    {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    if (fill(*message))
    {
      ring_.commit();
      computed_.fetch_add(1, std::memory_order_relaxed);
    }
  }

  /// Publisher thread: publishes what is waiting.
  void drain()
  {
    for (const Message* message = ring_.front(); message != nullptr; message = ring_.front())
    {
      publisher_.publish(*message);
      ring_.pop();
    }
  }

  ChannelCounters counters(const char* name) const noexcept { return { name, computed_, dropped_ }; }

private:
  SlotRing<Message> ring_;
  std::atomic<int> subscribers_{ 0 };
  std::atomic<std::uint64_t> computed_{ 0 };
  std::atomic<std::uint64_t> dropped_{ 0 };
  ros::Publisher publisher_;  // last: its callbacks use the rest
};

/// Everything the twin publishes. The loop fills the messages that are due and have subscribers; a thread sends them.
class OutputPublishers
{
public:
  OutputPublishers(ros::NodeHandle& node, const Twin& twin)
    : outputs_(&node, twin.parameters())
    , names_(twin.parameters().joint.name)
    , faults_(FAULT_SLOTS, {})
    , faults_publisher_(node.advertise<harmonic_joint_twin::Faults>(topics::FAULTS, 1, true))
    , offered_faults_(std::numeric_limits<std::uint64_t>::max())
    , thread_(
          [this]
          {
            outputs_.forEachSink([](auto& sink) { sink.drain(); });
            drainFaults();
          },
          [this] { return isHeard(); })
  {
  }

  /// Loop: fills the messages due at the twin's current instant that somebody hears. No allocation, no lock.
  void offer(Twin& twin) noexcept
  {
    offerFaults(twin);
    outputs_.offer(twin);
  }

  /// Loop: has the messages filled since the last call sent. Returns the next instant after this one whose messages
  /// somebody hears [ns]. No allocation, no lock that anybody holds for long.
  Stamp finishCycle(Stamp instant) noexcept
  {
    if (isHeard())
    {
      thread_.wakeUp();
    }
    return outputs_.nextDue(instant);
  }

  /// The faults published last, for a human reader.
  std::string activeFaults() const
  {
    const std::lock_guard<std::mutex> lock(text_mutex_);
    return active_faults_;
  }

  /// Counters of the channels, in the order of CHANNELS.
  std::array<ChannelCounters, CHANNEL_COUNT> counters() const noexcept
  {
    return outputs_.collect([](const auto& channel, const auto& sink) { return sink.counters(channel.name); });
  }

private:
  // Slots for lists of faults: one more change has to wait for the next instant.
  static constexpr std::size_t FAULT_SLOTS = 16;

  struct FaultsAt
  {
    Stamp stamp;
    FaultList faults;
  };

  /// The list of faults, once after each change.
  void offerFaults(const Twin& twin) noexcept
  {
    const FaultList& faults = twin.activeFaults();
    if (faults.version() == offered_faults_)
    {
      return;
    }
    if (FaultsAt* slot = faults_.claim())
    {
      slot->stamp = twin.stamp();
      slot->faults = faults;
      faults_.commit();
      offered_faults_ = faults.version();
    }
  }

  void drainFaults()
  {
    for (const FaultsAt* at = faults_.front(); at != nullptr; at = faults_.front())
    {
      const harmonic_joint_twin::Faults message = makeFaults(names_, at->stamp, at->faults);
      faults_.pop();
      faults_publisher_.publish(message);
      TextStream text;
      for (const harmonic_joint_twin::Fault& fault : message.faults)
      {
        text << (text.tellp() > 0 ? ", " : "") << fault.kind << ' ' << fault.severity << " at " << fault.place;
      }
      const std::lock_guard<std::mutex> lock(text_mutex_);
      active_faults_ = text.str();
    }
  }

  bool isHeard() const noexcept
  {
    const auto heard = outputs_.collect([](const auto&, const auto& sink) { return sink.isWanted(); });
    return std::any_of(heard.begin(), heard.end(), [](bool one) { return one; });
  }

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
