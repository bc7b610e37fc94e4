// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bags/message_decoder.hpp"
#include "bags/recorded_messages.hpp"

namespace hjt
{
/// @throws InputError.
std::unique_ptr<RecordedMessages> openDatabase(const std::string& path);
std::unique_ptr<RecordedMessages> openMcap(const std::string& path);

/// "sensor_msgs/msg/JointState" is "sensor_msgs/JointState".
std::string ros1Type(const std::string& type);

/// A topic of a ROS 2 file.
struct Ros2Channel
{
  std::string topic;
  std::string type;
  MessageEncoding encoding{};
  bool is_chosen{};
};

/// On a topic that is asked for. @throws InputError if that has another type than JointState.
bool isChosen(const Ros2Channel& channel, const std::vector<std::string>& topics, bool with_temperatures);

/// Reads and hands on one message of a chosen channel. False: the visitor has had enough.
class Ros2Message
{
public:
  explicit Ros2Message(const RecordedMessages::Visit& visit) : visit_(visit) {}

  bool take(const Ros2Channel& channel, Stamp recorded, const std::vector<std::uint8_t>& bytes);

private:
  const RecordedMessages::Visit& visit_;
  sensor_msgs::JointState state_;
  sensor_msgs::Temperature temperature_;
};
}  // namespace hjt
