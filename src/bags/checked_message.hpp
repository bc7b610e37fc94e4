// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <rosbag/message_instance.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Temperature.h>

namespace hjt
{
/// Reads JointState and Temperature messages out of bags whose bytes may be damaged.
///
/// A length that damage has made huge would let the message's own reading ask for as much memory, so the lengths are
/// held against the bytes that are there before.
class CheckedMessage
{
public:
  /// False: the bytes are no JointState, or cannot be read. @throws InputError if the topic has another
  /// type; a wrong md5sum alone is none.
  bool read(const rosbag::MessageInstance& instance);

  /// The same of a Temperature, whose type is known.
  bool readTemperature(const rosbag::MessageInstance& instance);

  const sensor_msgs::JointState& state() const noexcept { return state_; }
  const sensor_msgs::Temperature& temperature() const noexcept { return temperature_; }

private:
  template <class Message>
  bool take(const rosbag::MessageInstance& instance, Message& message);

  std::vector<std::uint8_t> bytes_;
  bool has_read_{};  // a JointState
  sensor_msgs::JointState state_;
  sensor_msgs::Temperature temperature_;
};
}  // namespace hjt
