// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/output_publishers.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>

#include "base/text_stream.hpp"

#include <ros/console.h>

namespace hjt
{
namespace
{
using std::chrono::milliseconds;

/// How long a message waits at most if the loop's wake-up was missed: it does not wait for the mutex.
constexpr milliseconds DRAIN_PERIOD{ 20 };
/// The same for a change of the faults while there are no subscribers.
constexpr milliseconds IDLE_PERIOD{ 100 };
/// Slots for lists of faults: one more change has to wait for the next instant.
constexpr std::size_t FAULT_SLOTS = 16;
}  // namespace

OutputPublishers::OutputPublishers(ros::NodeHandle& node, const Twin& twin)
  : outputs_(&node, twin.parameters())
  , names_(twin.parameters().joint.name)
  , faults_(FAULT_SLOTS, {})
  , faults_publisher_(node.advertise<harmonic_joint_twin::Faults>(topics::FAULTS, 1, true))
  , offered_faults_(std::numeric_limits<std::uint64_t>::max())
  , thread_([this] { run(); })
{
}

OutputPublishers::~OutputPublishers()
{
  {
    const std::lock_guard<std::mutex> lock(wake_up_mutex_);
    stopping_ = true;
  }
  wake_up_.notify_one();
  thread_.join();
}

void OutputPublishers::offer(Twin& twin) noexcept
{
  offerFaults(twin);
  outputs_.offer(twin);
}

Stamp OutputPublishers::finishCycle(Stamp instant) noexcept
{
  if (isHeard())
  {
    wake_up_.notify_one();
  }
  return outputs_.nextDue(instant);
}

/// The list of faults, once after each change.
void OutputPublishers::offerFaults(const Twin& twin) noexcept
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

void OutputPublishers::drainFaults()
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

std::string OutputPublishers::activeFaults() const
{
  const std::lock_guard<std::mutex> lock(text_mutex_);
  return active_faults_;
}

std::array<ChannelCounters, CHANNEL_COUNT> OutputPublishers::counters() const noexcept
{
  return outputs_.collect([](const auto& channel, const auto& sink) { return sink.counters(channel.name); });
}

bool OutputPublishers::isHeard() const noexcept
{
  const auto heard = outputs_.collect([](const auto&, const auto& sink) { return sink.isWanted(); });
  return std::any_of(heard.begin(), heard.end(), [](bool one) { return one; });
}

void OutputPublishers::run()
{
  std::unique_lock<std::mutex> lock(wake_up_mutex_);
  for (bool stopping = false; !stopping;)
  {
    if (!stopping_)
    {
      wake_up_.wait_for(lock, isHeard() ? DRAIN_PERIOD : IDLE_PERIOD);
    }
    stopping = stopping_;
    lock.unlock();
    try
    {
      outputs_.forEachSink([](auto& sink) { sink.drain(); });
      drainFaults();
    }
    catch (const std::exception& error)  // the thread's border: the next round goes on
    {
      ROS_WARN_STREAM_THROTTLE(60.0, "Messages of the twin are not published: " << error.what());
    }
    lock.lock();
  }
}
}  // namespace hjt
