// SPDX-License-Identifier: BSD-3-Clause
#include "bags/checked_message.hpp"

#include <cstring>
#include <exception>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
/// Walks over the parts of a serialized message.
class Walk
{
public:
  explicit Walk(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  void skip(std::size_t count)
  {
    fits_ = fits_ && count <= bytes_.size() - at_;
    at_ += fits_ ? count : 0;
  }

  std::uint32_t length()
  {
    std::uint32_t value = 0;
    const std::size_t from = at_;
    skip(sizeof(value));
    if (fits_)
    {
      std::memcpy(&value, bytes_.data() + from, sizeof(value));
    }
    return value;
  }

  bool fits() const { return fits_; }
  bool done() const { return fits_ && at_ == bytes_.size(); }

private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_{};
  bool fits_{ true };
};

/// Header (count, stamp, frame), names, then positions, velocities and efforts, to the last byte.
bool isJointState(const std::vector<std::uint8_t>& bytes)
{
  Walk walk(bytes);
  walk.skip(3 * sizeof(std::uint32_t));
  walk.skip(walk.length());
  const std::uint32_t names = walk.length();
  for (std::uint32_t i = 0; i < names && walk.fits(); ++i)
  {
    walk.skip(walk.length());
  }
  for (int array = 0; array < 3; ++array)
  {
    walk.skip(sizeof(double) * walk.length());
  }
  return walk.done();
}

/// Header, temperature and variance, to the last byte.
bool isTemperature(const std::vector<std::uint8_t>& bytes)
{
  Walk walk(bytes);
  walk.skip(3 * sizeof(std::uint32_t));
  walk.skip(walk.length());
  walk.skip(2 * sizeof(double));
  return walk.done();
}
}  // namespace

template <class Message>
bool CheckedMessage::take(const rosbag::MessageInstance& instance, Check is_whole, Message& message)
{
  try
  {
    bytes_.resize(instance.size());
    ros::serialization::OStream out(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    instance.write(out);
    if (!is_whole(bytes_))
    {
      return false;
    }
    ros::serialization::IStream in(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    ros::serialization::deserialize(in, message);
    return true;
  }
  catch (const std::exception&)
  {
    return false;
  }
}

bool CheckedMessage::read(const rosbag::MessageInstance& instance)
{
  if (!instance.isType<sensor_msgs::JointState>())
  {
    throw InputError(instance.getTopic() + " has type " + instance.getDataType() + ", expected sensor_msgs/JointState");
  }
  return take(instance, isJointState, state_);
}

bool CheckedMessage::readTemperature(const rosbag::MessageInstance& instance)
{
  return take(instance, isTemperature, temperature_);
}
}  // namespace hjt
