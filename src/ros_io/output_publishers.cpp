// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/output_publishers.hpp"

#include <algorithm>
#include <limits>

#include "base/text_stream.hpp"

namespace hjt
{
namespace
{
/// Slots for lists of faults: one more change has to wait for the next instant.
constexpr std::size_t FAULT_SLOTS = 16;
}  // namespace

OutputPublishers::OutputPublishers(ros::NodeHandle& node, const Twin& twin)
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

void OutputPublishers::offer(Twin& twin) noexcept
{
  offerFaults(twin);
  outputs_.offer(twin);
}

Stamp OutputPublishers::finishCycle(Stamp instant) noexcept
{
  if (isHeard())
  {
    thread_.wakeUp();
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

}  // namespace hjt
