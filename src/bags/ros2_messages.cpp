// SPDX-License-Identifier: BSD-3-Clause
#include "bags/ros2_messages.hpp"

#include <algorithm>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
std::string ros1Type(const std::string& type)
{
  const std::string middle = "/msg/";
  const std::size_t at = type.find(middle);
  return at == std::string::npos ? type : type.substr(0, at + 1) + type.substr(at + middle.size());
}

bool isChosen(const Ros2Channel& channel, const std::vector<std::string>& topics, bool with_temperatures)
{
  const bool is_named = std::find(topics.begin(), topics.end(), channel.topic) != topics.end();
  if (is_named && channel.type != JOINT_STATE_TYPE)
  {
    throw InputError(channel.topic + " has type " + channel.type + ", expected " + JOINT_STATE_TYPE);
  }
  return is_named || (with_temperatures && channel.type == TEMPERATURE_TYPE);
}

bool Ros2Message::take(const Ros2Channel& channel, Stamp recorded, const std::vector<std::uint8_t>& bytes)
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
}  // namespace hjt
