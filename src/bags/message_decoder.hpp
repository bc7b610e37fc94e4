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
enum class MessageEncoding
{
  ROS1,  ///< encoding of ROS 1: little-endian, without alignment
  CDR,   ///< encoding of ROS 2: XCDR 1 with either byte order; numbers are aligned to their size
  OTHER
};

/// The encoding with the name "ros1" or "cdr"; OTHER for another name.
MessageEncoding encodingOf(const std::string& name);

/// @returns false if the bytes are not exactly one message. Lengths are checked before memory is allocated.
bool decode(const std::vector<std::uint8_t>& bytes, MessageEncoding encoding, sensor_msgs::JointState& message);
bool decode(const std::vector<std::uint8_t>& bytes, MessageEncoding encoding, sensor_msgs::Temperature& message);

/// Reads JointState and Temperature messages from bags whose bytes may be damaged.
///
/// A damaged length could make generated code request much memory. This class first checks all lengths.
class CheckedMessage
{
public:
  /// Reads a JointState. @returns false if the bytes are damaged or are not a JointState. @throws InputError if the
  /// topic has another type. A wrong md5sum alone is no reason to throw.
  bool read(const rosbag::MessageInstance& instance)
  {
    const std::string expected = ros::message_traits::datatype<sensor_msgs::JointState>();
    if (instance.getDataType() != expected)
    {
      throw InputError(instance.getTopic() + " has type " + instance.getDataType() + ", expected " + expected);
    }
    const bool is_whole = take(instance, state_);
    has_read_ = has_read_ || is_whole;
    // A recorder may have stored a wrong md5sum. A message is accepted if its bytes can be decoded as a JointState.
    if (!has_read_ && !instance.isType<sensor_msgs::JointState>())
    {
      throw InputError(instance.getTopic() +
                       ": the messages cannot be read. They were recorded with another version of " + expected +
                       " (md5sum " + instance.getMD5Sum() + "; this program expects " +
                       ros::message_traits::md5sum<sensor_msgs::JointState>() + ")");
    }
    return is_whole;
  }

  /// Reads a Temperature. The caller has checked the type.
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
  bool has_read_{};  // whether at least one JointState was read
  sensor_msgs::JointState state_;
  sensor_msgs::Temperature temperature_;
};
}  // namespace hjt
