// SPDX-License-Identifier: BSD-3-Clause
#include "bags/checked_message.hpp"

#include <exception>
#include <string>

#include "bags/message_decoder.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
template <class Message>
bool CheckedMessage::take(const rosbag::MessageInstance& instance, Message& message)
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

bool CheckedMessage::read(const rosbag::MessageInstance& instance)
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

bool CheckedMessage::readTemperature(const rosbag::MessageInstance& instance)
{
  return take(instance, temperature_);
}
}  // namespace hjt
