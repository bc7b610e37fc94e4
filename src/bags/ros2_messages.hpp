// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "bags/message_decoder.hpp"
#include "bags/recorded_messages.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// @throws InputError.
std::unique_ptr<RecordedMessages> openDatabase(const std::string& path);

std::unique_ptr<RecordedMessages> openMcap(const std::string& path);

/// "sensor_msgs/msg/JointState" is "sensor_msgs/JointState".
inline std::string ros1Type(const std::string& type)
{
  const std::string middle = "/msg/";
  const std::size_t at = type.find(middle);
  return at == std::string::npos ? type : type.substr(0, at + 1) + type.substr(at + middle.size());
}

/// A topic of a ROS 2 file.
struct Ros2Channel
{
  std::string topic;
  std::string type;
  MessageEncoding encoding{};
  bool is_chosen{};
};

/// On a topic that is asked for. @throws InputError if that has another type than JointState.
inline bool isChosen(const Ros2Channel& channel, const std::vector<std::string>& topics, bool with_temperatures)
{
  const bool is_named = std::find(topics.begin(), topics.end(), channel.topic) != topics.end();
  if (is_named && channel.type != JOINT_STATE_TYPE)
  {
    throw InputError(channel.topic + " has type " + channel.type + ", expected " + JOINT_STATE_TYPE);
  }
  return is_named || (with_temperatures && channel.type == TEMPERATURE_TYPE);
}

/// Reads and hands on one message of a chosen channel. False: the visitor has had enough.
class Ros2Message
{
public:
  explicit Ros2Message(const RecordedMessages::Visit& visit) : visit_(visit) {}

  bool take(const Ros2Channel& channel, Stamp recorded, const std::vector<std::uint8_t>& bytes)
  {
    RecordedMessage message{ channel.topic, recorded, {} };
    if (channel.type == TEMPERATURE_TYPE)
    {
      message.temperature = decode(bytes, channel.encoding, temperature_) ? &temperature_ : nullptr;
    }
    else
    {
      message.state = decode(bytes, channel.encoding, state_) ? &state_ : nullptr;
    }
    return visit_(message);
  }

private:
  const RecordedMessages::Visit& visit_;
  sensor_msgs::JointState state_;
  sensor_msgs::Temperature temperature_;
};
}  // namespace hjt
