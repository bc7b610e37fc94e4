// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/bag_writer.hpp"

#include <filesystem>
#include <mutex>
#include <utility>

#include <console_bridge/console.h>
#include <rosbag/exceptions.h>

namespace hjt
{
BagWriter::BagWriter(std::string path)
  : path_(std::move(path)), active_path_(path_ + ".active"), lock_(active_path_), bag_(std::make_unique<rosbag::Bag>())
{
  // ROS' console sets the level to debug: rosbag would spell out a line for every message, which nobody reads.
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
  try
  {
    bag_->open(active_path_, rosbag::bagmode::Write);
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
  guarded([&](rosbag::Bag& bag)
          { bag.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader()); });
  ++messages_;
}

void BagWriter::close()
{
  if (!bag_)
  {
    return;
  }
  guarded([](rosbag::Bag& bag) { bag.close(); });
  bag_.reset();
  std::error_code error;
  if (messages_ > 0)
  {
    std::filesystem::rename(active_path_, path_, error);
  }
  else
  {
    std::filesystem::remove(active_path_, error);
  }
  if (error)
  {
    throw InputError(path_ + " cannot be written: " + error.message());
  }
}

void BagWriter::giveUp(const std::string& reason)
{
  // Its destructor would close it, and end the program when that throws.
  static std::mutex mutex;
  static std::vector<rosbag::Bag*> given_up;
  const std::lock_guard<std::mutex> lock(mutex);
  given_up.push_back(bag_.release());
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(active_path_, unknown);
  throw InputError(path_ + " cannot be written: " + reason + "; " + active_path_ + " has " + std::to_string(size) +
                   " bytes of " + std::to_string(messages_) +
                   " messages: `rosbag reindex` makes all but the last 0.8 MB readable");
}
}  // namespace hjt
