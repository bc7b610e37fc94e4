// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

#include "bags/bag_writer.hpp"
#include "messages/time.hpp"

namespace hjt
{
/// Where messages go in a bag.
struct BagContext
{
  BagWriter& bag;
  std::string prefix;  ///< of the topics' names
  Stamp delay{};       ///< of the time of recording behind the messages' stamps [ns]
};

/// Sink of one topic in a bag.
template <class Message>
class RecordedTopic
{
public:
  RecordedTopic(const BagContext& context, const char* name, Message first)
    : bag_(context.bag), topic_(context.prefix + name), delay_(context.delay), message_(std::move(first))
  {
  }

  bool isWanted() const { return true; }

  Message& message() { return message_; }
  void send() { bag_.write(topic_, fromRosTime(message_.header.stamp) + delay_, message_); }

private:
  BagWriter& bag_;
  std::string topic_;
  Stamp delay_;
  Message message_;
};
}  // namespace hjt
