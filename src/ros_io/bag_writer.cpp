// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/bag_writer.hpp"

#include <filesystem>
#include <utility>

#include <rosbag/exceptions.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
BagWriter::BagWriter(std::string path) : path_(std::move(path)), active_path_(path_ + ".active"), lock_(active_path_)
{
  try
  {
    bag_.open(active_path_, rosbag::bagmode::Write);
    open_ = true;
  }
  catch (const rosbag::BagException& error)
  {
    throw InputError(path_ + " cannot be written: " + error.what());
  }
}

BagWriter::~BagWriter()
{
  try
  {
    close();
  }
  catch (const InputError&)
  {
    // Nobody is left to tell.
  }
}

void BagWriter::copy(const rosbag::MessageInstance& message)
{
  // Read once before it is written: an error of reading in the midst of writing would leave half a record behind.
  scratch_.resize(message.size());
  ros::serialization::OStream stream(scratch_.data(), static_cast<std::uint32_t>(scratch_.size()));
  message.write(stream);
  bag_.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
  ++messages_;
}

void BagWriter::close()
{
  if (!open_)
  {
    return;
  }
  open_ = false;
  try
  {
    bag_.close();
    if (messages_ > 0)
    {
      std::filesystem::rename(active_path_, path_);
    }
    else
    {
      std::filesystem::remove(active_path_);
    }
  }
  catch (const std::exception& error)
  {
    throw InputError(path_ + " cannot be written: " + error.what());
  }
}
}  // namespace hjt
