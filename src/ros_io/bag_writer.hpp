// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include "base/file_lock.hpp"
#include "ros_io/time.hpp"

namespace hjt
{
/// Writes a bag as `PATH.active` and gives it its name when closed, as `rosbag record` does: what stands under the name is
/// always readable, also after an error or an interrupt. The same calls give the same bytes.
class BagWriter
{
public:
  /// @throws InputError if the file cannot be written, or another BagWriter writes it.
  explicit BagWriter(std::string path);

  /// Closes; an error of the disk is then swallowed, so call `close` where it matters.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  template <class Message>
  void write(const std::string& topic, Stamp stamp, const Message& message)
  {
    bag_.write(topic, toRosTime(stamp), message);
    ++messages_;
  }

  /// The message as it is: bytes, time, type and connection.
  void copy(const rosbag::MessageInstance& message);

  /// Leaves no file if nothing was written. @throws InputError if not all could be written.
  void close();

  const std::string& path() const { return path_; }
  std::uint64_t messages() const { return messages_; }

private:
  std::string path_;
  std::string active_path_;
  FileLock lock_;  // of active_path_
  rosbag::Bag bag_;
  std::vector<std::uint8_t> scratch_;
  std::uint64_t messages_{};
  bool open_{};
};
}  // namespace hjt
