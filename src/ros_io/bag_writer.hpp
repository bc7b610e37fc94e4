// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include "base/file_lock.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "ros_io/time.hpp"

namespace hjt
{
/// Writes a bag as `PATH.active` and gives it its name when closed, as `rosbag record` does: what stands under the name
/// is always readable, also after an error or an interrupt. The same calls give the same bytes.
///
/// Where the disk takes no more, the bag is given up: it stays as `PATH.active` without an index, and the InputError
/// tells how much is in it. `rosbag reindex` makes it readable but for the last chunk, 0.8 MB at most. Nothing can be
/// written after that.
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
    guarded([&](rosbag::Bag& bag) { bag.write(topic, toRosTime(stamp), message); });
    ++messages_;
  }

  /// The message as it is: bytes, time, type and connection. @throws rosbag::BagException if it cannot be read.
  void copy(const rosbag::MessageInstance& message);

  /// Leaves no file if nothing was written. @throws InputError if not all could be written.
  void close();

  bool isOpen() const { return bag_ != nullptr; }
  const std::string& path() const { return path_; }
  std::uint64_t messages() const { return messages_; }

private:
  template <class Action>
  void guarded(const Action& action)
  {
    if (!bag_)
    {
      throw InputError(path_ + " cannot be written: it is closed");
    }
    try
    {
      action(*bag_);
    }
    catch (const rosbag::BagException& error)
    {
      giveUp(error.what());
    }
  }

  [[noreturn]] void giveUp(const std::string& reason);

  std::string path_;
  std::string active_path_;
  FileLock lock_;                     // of active_path_
  std::unique_ptr<rosbag::Bag> bag_;  // none: closed
  std::vector<std::uint8_t> scratch_;
  std::uint64_t messages_{};
};
}  // namespace hjt
