// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/subscription_callback_helper.h>

namespace hjt
{
/// Subscribes topics that anybody may publish on. A message of more than MAX_BYTES bytes is counted and not read: what
/// it would hold in memory is a multiple of its length.
struct InputTopics
{
  /// Of the JointState of 1000 joints, twice over [bytes].
  static constexpr std::size_t MAX_BYTES = 128 * 1024;
  /// Seconds of messages at 1 kHz: a fast bag brings chunks, and a twin that catches up takes them later; none may be
  /// lost.
  static constexpr std::uint32_t QUEUE_SIZE = 4096;

  ros::NodeHandle& node;
  std::atomic<std::uint64_t>& too_large;

  template <class Message>
  ros::Subscriber subscribe(const char* topic,
                            const std::function<void(const ros::MessageEvent<const Message>&)>& receive) const
  {
    ros::SubscribeOptions options;
    options.topic = topic;
    options.queue_size = QUEUE_SIZE;
    options.md5sum = ros::message_traits::md5sum<Message>();
    options.datatype = ros::message_traits::datatype<Message>();
    options.helper = boost::make_shared<Reader<Message>>(receive, too_large);
    // Small messages at a high rate: without the delay that the transport would gather them with.
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    return node.subscribe(options);
  }

private:
  template <class Message>
  class Reader : public ros::SubscriptionCallbackHelperT<const ros::MessageEvent<const Message>&>
  {
  public:
    using Base = ros::SubscriptionCallbackHelperT<const ros::MessageEvent<const Message>&>;

    Reader(const std::function<void(const ros::MessageEvent<const Message>&)>& receive,
           std::atomic<std::uint64_t>& too_large)
      : Base(receive), too_large_(too_large)
    {
    }

    ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& message) override
    {
      if (message.length > MAX_BYTES)
      {
        ++too_large_;
        return {};
      }
      return Base::deserialize(message);
    }

  private:
    std::atomic<std::uint64_t>& too_large_;
  };
};
}  // namespace hjt
