// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "live/slot_ring.hpp"
#include "messages/channels.hpp"

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
}  // namespace hjt
