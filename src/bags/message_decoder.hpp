// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include <rosbag/message_instance.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Temperature.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// How the bytes of a message are to be read.
enum class MessageEncoding
{
  ROS1,  ///< little endian, unaligned
  CDR,   ///< of ROS 2: XCDR 1, either byte order, numbers aligned to their size
  OTHER
};

/// "ros1", "cdr".
MessageEncoding encodingOf(const std::string& name);

/// False: the bytes are no such message to the last byte. Lengths are held against the bytes before memory is taken.
bool decode(const std::vector<std::uint8_t>& bytes, MessageEncoding encoding, sensor_msgs::JointState& message);
bool decode(const std::vector<std::uint8_t>& bytes, MessageEncoding encoding, sensor_msgs::Temperature& message);

/// Reads JointState and Temperature messages out of bags whose bytes may be damaged.
///
/// A length that damage has made huge would let the message's own reading ask for as much memory, so the lengths are
/// held against the bytes that are there before.
class CheckedMessage
{
public:
  /// False: the bytes are no JointState, or cannot be read. @throws InputError if the topic has another
  /// type; a wrong md5sum alone is none.
  bool read(const rosbag::MessageInstance& instance)
  {
    const std::string expected = ros::message_traits::datatype<sensor_msgs::JointState>();
    if (instance.getDataType() != expected)
    {
      throw InputError(instance.getTopic() + " has type " + instance.getDataType() + ", expected " + expected);
    }
    const bool is_whole = take(instance, state_);
    has_read_ = has_read_ || is_whole;
    // A recorder's own mistake in the sum is no matter where the bytes are those of the message.
    if (!has_read_ && !instance.isType<sensor_msgs::JointState>())
    {
      throw InputError(instance.getTopic() + ": its messages are of another " + expected +
                       " than this one: their md5sum is " + instance.getMD5Sum() + ", expected " +
                       ros::message_traits::md5sum<sensor_msgs::JointState>() + ", and their bytes do not fit");
    }
    return is_whole;
  }

  /// The same of a Temperature, whose type is known.
  bool readTemperature(const rosbag::MessageInstance& instance) { return take(instance, temperature_); }

  const sensor_msgs::JointState& state() const noexcept { return state_; }
  const sensor_msgs::Temperature& temperature() const noexcept { return temperature_; }

private:
  template <class Message>
  bool take(const rosbag::MessageInstance& instance, Message& message)
  {
    try
    {
      bytes_.resize(instance.size());
      ros::serialization::OStream out(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
      instance.write(out);
      return decode(bytes_, MessageEncoding::ROS1, message);
    }
    catch (const std::exception&)
    {
      return false;
    }
  }

  std::vector<std::uint8_t> bytes_;
  bool has_read_{};  // a JointState
  sensor_msgs::JointState state_;
  sensor_msgs::Temperature temperature_;
};
}  // namespace hjt
