// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>

#include "bags/bag_writer.hpp"
#include "messages/channels.hpp"

namespace hjt
{
/// Writes the topics of a twin to a bag, with the messages that the node would publish at the same simulated instants.
class BagRecorder
{
public:
  /// `joint_namespace`: namespace of the topics, for example "/joint_twin".
  BagRecorder(const Twin& twin, const std::string& joint_namespace, BagWriter& bag)
    : context_{ bag, joint_namespace + "/" }
    , names_(twin.parameters().joint.name)
    , recorded_faults_(twin.activeFaults().empty() ? twin.activeFaults().version() :
                                                     std::numeric_limits<std::uint64_t>::max())
    , outputs_(context_, twin.parameters())
  {
  }

  /// The caller calls this function after every step of the twin.
  void record(Twin& twin)
  {
    if (const FaultList& faults = twin.activeFaults(); faults.version() != recorded_faults_)
    {
      recorded_faults_ = faults.version();
      context_.bag.write(context_.prefix + topics::FAULTS, twin.stamp(), makeFaults(names_, twin.stamp(), faults));
    }
    outputs_.offer(twin);
  }

private:
  template <class Message>
  class RecordedChannel
  {
  public:
    RecordedChannel(const BagContext& context, const Channel<Message>& channel, Message first)
      : topic_(context, channel.name, std::move(first))
    {
    }
    bool isWanted() const { return true; }

    template <class Fill>
    void write(Fill&& fill)
    {
      if (fill(topic_.message()))
      {
        topic_.send();
      }
    }

  private:
    RecordedTopic<Message> topic_;
  };

  BagContext context_;
  JointNames names_;
  std::uint64_t recorded_faults_;  // version of the list of faults that was recorded last
  Outputs<RecordedChannel> outputs_;
};
}  // namespace hjt
