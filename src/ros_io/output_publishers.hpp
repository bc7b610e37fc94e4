// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/wall_timer.h>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/Timing.h"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "live/thread_exchange.hpp"
#include "live/twin_loop.hpp"
#include "messages/channels.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"

namespace hjt
{
/// Thread that sends the messages which a loop has filled. The loop cannot send, because sending allocates and locks.
class PublisherThread
{
public:
  /// `drain`: sends all waiting messages; the thread calls it. `is_heard`: whether a topic has a subscriber.
  PublisherThread(std::function<void()> drain, std::function<bool()> is_heard)
    : drain_(std::move(drain)), is_heard_(std::move(is_heard)), thread_([this] { run(); })
  {
  }

  /// Sends the remaining messages and stops the thread.
  ~PublisherThread()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    wake_up_.notify_one();
    thread_.join();
  }

  /// For the loop: wakes the thread, which sends. The call does not allocate and takes no lock that is held for long.
  void wakeUp() noexcept { wake_up_.notify_one(); }

private:
  // Longest delay of a message if the thread misses a wake-up, which can happen because the loop takes no mutex.
  static constexpr std::chrono::milliseconds DRAIN_PERIOD{ 20 };
  // Longest delay of a message about changed faults while no topic has a subscriber.
  static constexpr std::chrono::milliseconds IDLE_PERIOD{ 100 };

  void run()
  {
    std::unique_lock<std::mutex> lock(mutex_);
    for (bool stopping = false; !stopping;)
    {
      if (!stopping_)
      {
        wake_up_.wait_for(lock, is_heard_() ? DRAIN_PERIOD : IDLE_PERIOD);
      }
      stopping = stopping_;
      lock.unlock();
      try
      {
        drain_();
      }
      catch (const std::exception& error)  // no exception may leave a thread; the thread tries again in the next round
      {
        ROS_WARN_STREAM_THROTTLE(60.0, "The node cannot publish messages of the twin: " << error.what());
      }
      lock.lock();
    }
  }

  std::function<void()> drain_;
  std::function<bool()> is_heard_;
  std::mutex mutex_;
  std::condition_variable wake_up_;
  bool stopping_{};  // protected by mutex_
  std::thread thread_;
};

struct ChannelCounters
{
  const char* name{};
  std::uint64_t computed{};  ///< number of messages filled since the start of the node
  std::uint64_t dropped{};   ///< number of due messages that were not filled, because the buffer was full
};

/// A live topic. The loop fills preallocated messages, and another thread publishes them.
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

  bool isWanted() const noexcept { return subscribers_.load(std::memory_order_relaxed) > 0; }

  /// For the loop: lets `fill(Message&)` write the next message. If `fill` returns false, there is no message. If the
  /// buffer is full, the message is dropped and counted.
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

  /// For the publisher's thread: publishes all waiting messages.
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
  ros::Publisher publisher_;  // last member, because the publisher's callbacks use the other members
};

/// All topics of the twin. The loop fills due messages that have subscribers, and a thread sends them.
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

  /// For the loop: fills the messages that are due at the twin's current instant and have subscribers, without
  /// allocation or lock.
  void offer(Twin& twin) noexcept
  {
    offerFaults(twin);
    outputs_.offer(twin);
  }

  /// For the loop: starts sending the filled messages. @returns the next instant with a message for a subscriber [ns].
  /// The call does not allocate and takes no lock that is held for long.
  Stamp finishCycle(Stamp instant) noexcept
  {
    if (isHeard())
    {
      thread_.wakeUp();
    }
    return outputs_.nextDue(instant);
  }

  std::string activeFaults() const
  {
    const std::lock_guard<std::mutex> lock(text_mutex_);
    return active_faults_;
  }

  /// Counted messages of the channels, in the order of CHANNELS.
  std::array<ChannelCounters, CHANNEL_COUNT> counters() const noexcept
  {
    return outputs_.collect([](const auto& channel, const auto& sink) { return sink.counters(channel.name); });
  }

private:
  // Number of lists of faults that can wait for the thread. If all are in use, a change waits for the next instant.
  static constexpr std::size_t FAULT_SLOTS = 16;

  struct FaultsAt
  {
    Stamp stamp;
    FaultList faults;
  };

  /// Offers the list of active faults to the publishing thread, once after each change.
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
  std::uint64_t offered_faults_;  // version of the last offered list of faults
  mutable std::mutex text_mutex_;
  std::string active_faults_;
  PublisherThread thread_;  // last member, because the thread uses the other members
};

/// Publishes the loop's timing once a second in wall clock time, if ~timing has subscribers.
class TimingPublisher
{
public:
  TimingPublisher(ros::NodeHandle& node, const Parameters& parameters, const TwinLoop& loop)
    : loop_(loop), publisher_(node.advertise<harmonic_joint_twin::Timing>(topics::TIMING, QUEUE_LENGTH))
  {
    message_.header.frame_id = parameters.joint.name;
    message_.deadline = parameters.realtime.deadline;
    for (std::size_t bin = 0; bin < LatencyHistogram::BIN_COUNT; ++bin)
    {
      message_.bin_end.push_back(toSeconds(LatencyHistogram::binEnd(bin)));
    }
    timer_ = node.createWallTimer(ros::WallDuration(PERIOD), [this](const ros::WallTimerEvent&) { publish(); });
  }

private:
  static constexpr double PERIOD = 1.0;  // time between two messages in wall clock time [s]
  static constexpr std::uint32_t QUEUE_LENGTH = 10;

  void publish()
  {
    if (publisher_.getNumSubscribers() == 0)
    {
      return;
    }
    const LoopTiming timing = loop_.status().timing;
    message_.header.stamp = ros::Time::now();
    message_.duration = toSeconds(timing.elapsed);
    message_.real_time_factor = timing.realTimeFactor();
    message_.load = timing.load();
    message_.longest_cycle = toSeconds(timing.longest_cycle);
    message_.missed_deadlines = timing.missed_deadlines;
    message_.wake_up_median = toSeconds(timing.wake_up.quantile(0.5));
    message_.wake_up_p99 = toSeconds(timing.wake_up.quantile(0.99));
    message_.wake_up_p999 = toSeconds(timing.wake_up.quantile(0.999));
    message_.wake_up_max = toSeconds(timing.wake_up.largest());
    message_.lateness_median = toSeconds(timing.lateness.quantile(0.5));
    message_.lateness_p99 = toSeconds(timing.lateness.quantile(0.99));
    message_.lateness_p999 = toSeconds(timing.lateness.quantile(0.999));
    message_.lateness_max = toSeconds(timing.lateness.largest());
    message_.wake_up_count.assign(timing.wake_up.bins().begin(), timing.wake_up.bins().end());
    message_.lateness_count.assign(timing.lateness.bins().begin(), timing.lateness.bins().end());
    publisher_.publish(message_);
  }

  const TwinLoop& loop_;
  harmonic_joint_twin::Timing message_;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};
}  // namespace hjt
