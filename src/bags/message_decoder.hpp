// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Temperature.h>

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
}  // namespace hjt
