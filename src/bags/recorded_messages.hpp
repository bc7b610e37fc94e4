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
/// Format of a recording, determined by its first bytes.
enum class RecordingFormat
{
  BAG,        ///< bag of ROS 1
  DATABASE,   ///< SQLite database: a .db3 file of rosbag2
  MCAP,       ///< MCAP file of rosbag2
  DIRECTORY,  ///< directory of rosbag2 with such files
  TABLE       ///< text table: a CSV file
};

/// @throws InputError if the file cannot be read or has another format. The text names the format and a command that
/// converts
/// it.
RecordingFormat formatOfRecording(const std::string& path);

/// @throws InputError if the file contains messages, which have no targets; the text ends with `wanted`.
void requireTable(const std::string& path, const std::string& wanted);

/// Text for the end of an error about a ROS 2 file: how to convert it to a bag.
std::string conversionOf(const std::string& path);

constexpr const char* JOINT_STATE_TYPE = "sensor_msgs/JointState";
constexpr const char* TEMPERATURE_TYPE = "sensor_msgs/Temperature";

/// A message of a recording; valid until the next one is read.
struct RecordedMessage
{
  const std::string& topic;
  Stamp recorded{};                               ///< time of recording [ns]
  std::string publisher;                          ///< name of the publishing node; empty: not recorded
  const sensor_msgs::JointState* state{};         ///< null if the message has another type or is damaged
  const sensor_msgs::Temperature* temperature{};  ///< null if the message has another type or is damaged

  /// Stamp of the header, or the time of recording if that is zero [ns].
  Stamp stamp() const;
};

struct TopicMessages
{
  std::string type;  ///< type in the spelling of ROS 1, "sensor_msgs/JointState"
  std::uint64_t messages{};
};

/// JointState and Temperature messages of a recording: a bag, a .db3 or .mcap file of ROS 2, or a directory of such
/// files.
class RecordedMessages
{
public:
  using Visit = std::function<bool(const RecordedMessage& message)>;
  using Progress = std::function<void(double share)>;

  /// @throws InputError if the file cannot be read, with the reason or a command that converts it.
  static std::unique_ptr<RecordedMessages> open(const std::string& path);

  virtual ~RecordedMessages() = default;

  const std::map<std::string, TopicMessages>& topics() const { return topics_; }
  std::uint64_t messagesOn(const std::string& topic) const;
  /// Text of the topics with their types, one per line.
  std::string listTopics() const;
  /// @throws InputError if the topic has no message or another type; the text lists the existing topics.
  void requireStates(const std::string& topic) const;

  /// Calls `visit` with the messages on these topics, and with every Temperature if `with_temperatures`, in the order
  /// of recording until it returns false.
  /// @throws InputError if one of `topics` has another type than JointState.
  virtual void visit(const std::vector<std::string>& topics, bool with_temperatures, const Visit& visit,
                     const Progress& progress) = 0;

  /// Text on skipped parts of a damaged file; empty: none.
  const std::string& remark() const { return remark_; }

protected:
  explicit RecordedMessages(std::string path) : path_(std::move(path)) {}

  const std::string path_;
  std::map<std::string, TopicMessages> topics_;
  std::string remark_;
};

/// Opens a file of ROS 2. @throws InputError.
std::unique_ptr<RecordedMessages> openDatabase(const std::string& path);
std::unique_ptr<RecordedMessages> openMcap(const std::string& path);
}  // namespace hjt
