// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Temperature.h>

#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt
{
/// Format of a recording. The first bytes of the file determine it.
enum class RecordingFormat
{
  BAG,        ///< bag of ROS 1
  DATABASE,   ///< SQLite database: a .db3 file of rosbag2
  MCAP,       ///< MCAP file of rosbag2
  DIRECTORY,  ///< directory with .db3 or .mcap files of rosbag2
  TABLE       ///< text table: a CSV file
};

/// @throws InputError if the file is unreadable or has another format. The text names a command that converts it.
RecordingFormat formatOfRecording(const std::string& path);

/// @throws InputError if the file contains messages, because messages have no set points; the text ends with `wanted`.
void requireTable(const std::string& path, const std::string& wanted);

/// Text for the end of an error about a file of ROS 2. It says how to convert the file to a bag.
std::string conversionOf(const std::string& path);

constexpr const char* JOINT_STATE_TYPE = "sensor_msgs/JointState";
constexpr const char* TEMPERATURE_TYPE = "sensor_msgs/Temperature";

/// A message of a recording. It is valid until the next message is read.
struct RecordedMessage
{
  const std::string& topic;
  Stamp recorded{};                               ///< time of recording [ns]
  std::string publisher;                          ///< name of the node that published the message; empty: not recorded
  const sensor_msgs::JointState* state{};         ///< null if the message has another type or is damaged
  const sensor_msgs::Temperature* temperature{};  ///< null if the message has another type or is damaged

  /// Stamp of the header or, if the stamp is zero, the time of recording [ns].
  Stamp stamp() const;
};

struct TopicMessages
{
  std::string type;  ///< type as ROS 1 spells it, for example "sensor_msgs/JointState"
  std::uint64_t messages{};
};

/// Messages of types JointState and Temperature in a bag, a .db3 or .mcap file of ROS 2, or a directory of such files.
class RecordedMessages
{
public:
  using Visit = std::function<bool(const RecordedMessage& message)>;
  using Progress = std::function<void(double share)>;

  /// @throws InputError if the file cannot be read. The text has the reason or a command that converts the file.
  static std::unique_ptr<RecordedMessages> open(const std::string& path);

  virtual ~RecordedMessages() = default;

  const std::map<std::string, TopicMessages>& topics() const { return topics_; }
  std::uint64_t messagesOn(const std::string& topic) const;
  /// Text that lists the topics with their types, one per line.
  std::string listTopics() const;
  /// @throws InputError if the topic has no messages or another type. The text lists the existing topics.
  void requireStates(const std::string& topic) const;

  /// Calls `visit` with the messages on `topics`, and with every Temperature if `with_temperatures`. The messages come
  /// in the order of recording, until `visit` returns false. @throws InputError if one of `topics` has another type
  /// than JointState.
  virtual void visit(const std::vector<std::string>& topics, bool with_temperatures, const Visit& visit,
                     const Progress& progress) = 0;

  /// Text on skipped parts of a damaged file; empty if nothing was skipped.
  const std::string& remark() const { return remark_; }

protected:
  explicit RecordedMessages(std::string path) : path_(std::move(path)) {}

  const std::string path_;
  std::map<std::string, TopicMessages> topics_;
  std::string remark_;
};

/// Opens a file of ROS 2. @throws InputError if the file cannot be read.
std::unique_ptr<RecordedMessages> openDatabase(const std::string& path);
std::unique_ptr<RecordedMessages> openMcap(const std::string& path);
}  // namespace hjt
