// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ros/datatypes.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/message_instance.h>

#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/time.hpp"

namespace hjt
{
/// Lock of a file against other processes that use FileLock. The lock ends with this object or with the process.
class FileLock
{
public:
  /// Makes the file if it is missing, without following a link. @throws InputError if this fails, if the path is not a
  /// regular file, or if another process holds the lock.
  explicit FileLock(const std::string& path)
    : descriptor_(open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666))
  {
    if (descriptor_ < 0)
    {
      throw InputError(path + " cannot be written: " + std::strerror(errno));
    }
    struct stat status
    {
    };
    std::string error;
    if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode))
    {
      error = " cannot be written, because it is not a regular file";
    }
    else if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
    {
      error = errno == EWOULDBLOCK ? " is being written by another program" :
                                     std::string(" cannot be locked: ") + std::strerror(errno);
    }
    if (!error.empty())
    {
      close(descriptor_);
      throw InputError(path + error);
    }
  }

  ~FileLock() { close(descriptor_); }

  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

private:
  int descriptor_;
};

/// Writes a bag as `PATH.active` and renames it when it is closed, as `rosbag record` does. So a file with the final
/// name is always readable, also after an error or an interrupt. Equal calls give equal bytes, the same as those of an
/// uncompressed bag of rosbag::Bag. Each chunk is written at once, whereas rosbag::Bag seeks twice for each message.
///
/// If the disk is full, `PATH.active` remains without an index, and the InputError says how much it contains. `rosbag
/// reindex` makes it readable except for the last chunk of at most 0.8 MB. After this error, the object writes nothing
/// more.
///
/// Format: http://wiki.ros.org/Bags/Format/2.0
class BagWriter
{
public:
  /// @throws InputError if the file cannot be written, or if another BagWriter is writing it.
  explicit BagWriter(std::string path);

  /// Closes the bag. Only `close` reports errors of the disk; the destructor ignores them.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Writes a message. @throws InputError if the disk is full, or if the stamp is zero, which a bag cannot contain.
  template <class Message>
  void write(const std::string& topic, Stamp stamp, const Message& message)
  {
    namespace traits = ros::message_traits;
    const ros::Time time = begin(stamp);
    const auto known = topics_.find(topic);
    const std::uint32_t connection = known != topics_.end() ?
                                         known->second :
                                         topics_[topic] =
                                             connect(topic, { { "type", traits::datatype(message) },
                                                              { "md5sum", traits::md5sum(message) },
                                                              { "message_definition", traits::definition(message) } });
    const std::uint32_t size = ros::serialization::serializationLength(message);
    ros::serialization::OStream stream(append(connection, time, size), size);
    ros::serialization::serialize(stream, message);
    end();
  }

  /// Copies a message with its bytes, time, type and connection. @throws rosbag::BagException if it is unreadable.
  void copy(const rosbag::MessageInstance& message);

  /// Closes the bag. A bag without messages leaves no file. @throws InputError if not all data could be written.
  void close();

  bool isOpen() const { return file_ != nullptr; }
  const std::string& path() const { return path_; }
  std::uint64_t messages() const { return messages_; }

private:
  struct IndexEntry
  {
    ros::Time time;
    std::uint32_t offset;  // position of the message in the chunk [byte]
  };

  struct Connection
  {
    std::string topic;
    ros::M_string header;
    std::vector<IndexEntry> index;  // messages of this connection in the present chunk
  };

  struct ChunkInfo
  {
    std::uint64_t position{};
    ros::Time first;
    ros::Time last;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;  // connection and number of its messages
  };

  ros::Time begin(Stamp stamp);
  std::uint32_t connect(const std::string& topic, const ros::M_string& header);
  std::uint8_t* append(std::uint32_t connection, const ros::Time& time, std::uint32_t size);
  void end();
  void writeChunk();
  void writeFileHeader(std::uint64_t index_position);
  void flush(const std::vector<std::uint8_t>& bytes);
  [[noreturn]] void giveUp(const std::string& reason);

  std::string path_;
  std::string active_path_;
  FileLock lock_;                                         // lock of the file at active_path_
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;  // null if the bag is closed
  std::uint64_t position_{};                              // position in the file [byte]
  std::vector<std::uint8_t> chunk_;                       // messages and new connections of the present chunk
  ChunkInfo running_;
  std::vector<ChunkInfo> chunks_;
  std::vector<Connection> connections_;
  std::map<std::string, std::uint32_t> topics_;    // numbers of the connections that `write` made, by topic
  std::map<ros::M_string, std::uint32_t> copied_;  // numbers of the connections that `copy` made, by header and topic
  // Numbers of the connections that `copy` made, by pointer to the header, for a faster search.
  std::map<boost::shared_ptr<ros::M_string>, std::uint32_t> copied_headers_;
  std::vector<std::uint8_t> scratch_;
  std::uint64_t messages_{};
};

struct BagContext
{
  BagWriter& bag;
  std::string prefix;  ///< prefix of the topic names
  Stamp delay{};       ///< times of recording minus stamps of the messages [ns]
};

/// Writes the messages of one topic to a bag.
template <class Message>
class RecordedTopic
{
public:
  RecordedTopic(const BagContext& context, const char* name, Message first)
    : bag_(context.bag), topic_(context.prefix + name), delay_(context.delay), message_(std::move(first))
  {
  }

  bool isWanted() const { return true; }

  Message& message() { return message_; }
  void send() { bag_.write(topic_, fromRosTime(message_.header.stamp) + delay_, message_); }

private:
  BagWriter& bag_;
  std::string topic_;
  Stamp delay_;
  Message message_;
};
}  // namespace hjt
