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
/// Format of a recording, by its first bytes and not by its name.
enum class RecordingFormat
{
  BAG,        ///< of ROS 1
  DATABASE,   ///< SQLite, a .db3 of rosbag2
  MCAP,       ///< .mcap
  DIRECTORY,  ///< of rosbag2, with such files
  TABLE       ///< text: a CSV file
};

/// @throws InputError if the file cannot be read, or is of a format that nothing here reads: it names the format and
/// what converts it.
RecordingFormat formatOfRecording(const std::string& path);

/// @throws InputError if it is a file of messages, which hold no targets: `wanted` is read of a table.
void requireTable(const std::string& path, const std::string& wanted);

/// The sentence to end an error of a ROS 2 file with: how to make a bag of it.
std::string conversionOf(const std::string& path);

constexpr const char* JOINT_STATE_TYPE = "sensor_msgs/JointState";
constexpr const char* TEMPERATURE_TYPE = "sensor_msgs/Temperature";

/// One message of a recording; valid until the next one is read.
struct RecordedMessage
{
  const std::string& topic;
  Stamp recorded{};                               ///< [ns]
  std::string publisher;                          ///< name of the node; empty: the recording does not tell
  const sensor_msgs::JointState* state{};         ///< none: not of this type, or damaged
  const sensor_msgs::Temperature* temperature{};  ///< likewise

  /// That of its header, or the time of recording where that is zero [ns].
  Stamp stamp() const;
};

struct TopicMessages
{
  std::string type;  ///< as ROS 1 spells it, "sensor_msgs/JointState"
  std::uint64_t messages{};
};

/// JointState and Temperature messages of a recording: a bag, a .db3 or .mcap file of ROS 2, or a directory with such
/// files.
class RecordedMessages
{
public:
  using Visit = std::function<bool(const RecordedMessage& message)>;
  using Progress = std::function<void(double share)>;

  /// @throws InputError if the file cannot be read; it says what is wrong, or what converts it.
  static std::unique_ptr<RecordedMessages> open(const std::string& path);

  virtual ~RecordedMessages() = default;

  const std::map<std::string, TopicMessages>& topics() const { return topics_; }
  std::uint64_t messagesOn(const std::string& topic) const;
  /// One a line, with their types.
  std::string listTopics() const;
  /// @throws InputError if there is no message on the topic, or of another type; it names the topics that are there.
  void requireStates(const std::string& topic) const;

  /// The messages on these topics, and every Temperature if `with_temperatures`, in the order of their recording, until
  /// `visit` returns false.
  /// @throws InputError if a topic of `topics` has another type than JointState.
  virtual void visit(const std::vector<std::string>& topics, bool with_temperatures, const Visit& visit,
                     const Progress& progress) = 0;

  /// Parts of a damaged file that were left out; empty: none.
  const std::string& remark() const { return remark_; }

protected:
  explicit RecordedMessages(std::string path) : path_(std::move(path)) {}

  const std::string path_;
  std::map<std::string, TopicMessages> topics_;
  std::string remark_;
};

/// Of a file of ROS 2. @throws InputError.
std::unique_ptr<RecordedMessages> openDatabase(const std::string& path);
std::unique_ptr<RecordedMessages> openMcap(const std::string& path);
}  // namespace hjt
