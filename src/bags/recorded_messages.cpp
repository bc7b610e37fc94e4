// SPDX-License-Identifier: BSD-3-Clause
#include "bags/recorded_messages.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bags/bag_file.hpp"
#include "bags/message_decoder.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/time.hpp"

namespace hjt
{
namespace
{
using namespace std::string_view_literals;

struct Read
{
  std::string_view magic;
  RecordingFormat format;
};

constexpr std::array<Read, 3> READ{ { { "#ROSBAG V2.0"sv, RecordingFormat::BAG },
                                      { "SQLite format 3\0"sv, RecordingFormat::DATABASE },
                                      { "\x89MCAP0\r\n"sv, RecordingFormat::MCAP } } };

struct Refused
{
  std::string_view magic;
  const char* text;
};

constexpr std::array<Refused, 12> REFUSED{ {
    { "#ROSBAG V1"sv, "a bag of format 1; `rosbag fix` of ROS 1 converts it to format 2.0" },
    { "\x28\xB5\x2F\xFD"sv, "compressed by zstd; `zstd -d FILE` decompresses it" },
    { "\x1F\x8B"sv, "compressed by gzip; `gunzip FILE` decompresses it" },
    { "BZh"sv, "compressed by bzip2; `bunzip2 FILE` decompresses it" },
    { "\xFD"
      "7zXZ"sv,
      "compressed by xz; `unxz FILE` decompresses it" },
    { "PK\x03\x04"sv, "a zip archive or a spreadsheet (.zip, .xlsx, .npz); save its table as CSV" },
    { "\x89HDF"sv, "an HDF5 file; save its table as CSV" },
    { "MATLAB 5.0"sv, "a MATLAB file; writetable saves its table as CSV" },
    { "PAR1"sv, "a Parquet file; save its table as CSV" },
    { "\xFF\xFE"sv, "a text in UTF-16; `iconv -f UTF-16 -t UTF-8 FILE` converts it to UTF-8" },
    { "\xFE\xFF"sv, "a text in UTF-16; `iconv -f UTF-16 -t UTF-8 FILE` converts it to UTF-8" },
    { "ULog"sv, "a PX4 log; ulog2csv converts it to CSV" },
} };
}  // namespace

std::string conversionOf(const std::string& path)
{
  return "`rosbags-convert --src " + path + " --dst " + std::filesystem::path(path).stem().string() +
         ".bag` (pip install rosbags) converts it to a bag";
}

RecordingFormat formatOfRecording(const std::string& path)
{
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
  {
    return RecordingFormat::DIRECTORY;
  }
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open())
  {
    throw InputError(path + " cannot be read: " + std::strerror(errno));
  }
  std::array<char, 512> bytes{};
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const std::string_view begin(bytes.data(), static_cast<std::size_t>(file.gcount()));
  if (begin.empty())
  {
    throw InputError(path + " is empty");
  }
  for (const Read& known : READ)
  {
    if (begin.substr(0, known.magic.size()) == known.magic)
    {
      return known.format;
    }
  }
  for (const Refused& known : REFUSED)
  {
    if (begin.substr(0, known.magic.size()) == known.magic)
    {
      throw InputError(path + " is " + known.text);
    }
  }
  const bool is_named_bag = std::filesystem::path(path).extension() == ".bag";
  if (is_named_bag || begin.find('\0') != std::string_view::npos)
  {
    throw InputError(path +
                     (is_named_bag ? " cannot be read as a bag: it has no bag header of format 2.0 at byte 0" :
                                     " is neither a recording of ROS nor a text table") +
                     ". Give a bag, a .db3 or .mcap file of ROS 2, or CSV");
  }
  return RecordingFormat::TABLE;
}

void requireTable(const std::string& path, const std::string& wanted)
{
  if (std::filesystem::is_regular_file(path) && formatOfRecording(path) != RecordingFormat::TABLE)
  {
    throw InputError(path + " contains messages, which have no targets; " + wanted);
  }
}

namespace
{
namespace fs = std::filesystem;

class BagMessages : public RecordedMessages
{
public:
  explicit BagMessages(const std::string& path) : RecordedMessages(path)
  {
    openForReading(bag_, path);
    rosbag::View view(bag_);
    for (const rosbag::ConnectionInfo* connection : view.getConnections())
    {
      topics_[connection->topic].type = connection->datatype;
    }
    for (auto& [name, topic] : topics_)
    {
      topic.messages = rosbag::View(bag_, rosbag::TopicQuery(name)).size();
    }
  }

  void visit(const std::vector<std::string>& topics, bool with_temperatures, const Visit& visit,
             const Progress& progress) override
  {
    rosbag::View view;
    view.addQuery(bag_, rosbag::TopicQuery(topics));
    if (with_temperatures)
    {
      view.addQuery(bag_, rosbag::TypeQuery(TEMPERATURE_TYPE));
    }
    const double total = view.size();
    double done = 0.0;
    CheckedMessage message;
    for (const rosbag::MessageInstance& instance : view)
    {
      const std::string topic = instance.getTopic();
      RecordedMessage recorded{ topic, fromRosTime(instance.getTime()), instance.getCallerId() };
      if (instance.getDataType() == TEMPERATURE_TYPE && with_temperatures)
      {
        recorded.temperature = message.readTemperature(instance) ? &message.temperature() : nullptr;
      }
      else
      {
        recorded.state = message.read(instance) ? &message.state() : nullptr;
      }
      if (!visit(recorded))
      {
        return;
      }
      progress(++done / total);
    }
  }

private:
  rosbag::Bag bag_;
};

/// Messages of all files in a directory of rosbag2, or of all parts of a split bag.
class DirectoryMessages : public RecordedMessages
{
public:
  explicit DirectoryMessages(const std::string& path) : RecordedMessages(path)
  {
    std::vector<std::string> files;
    std::vector<std::string> bags;
    std::string compressed;
    for (const fs::directory_entry& entry : fs::directory_iterator(path))
    {
      const std::string ending = entry.path().extension().string();
      if (ending == ".db3" || ending == ".mcap")
      {
        files.push_back(entry.path().string());
      }
      if (ending == ".bag")
      {
        bags.push_back(entry.path().string());
      }
      compressed = ending == ".zstd" ? entry.path().string() : compressed;
    }
    files = files.empty() ? bags : files;
    if (files.empty())
    {
      throw InputError(path + " is a directory without .db3, .mcap and .bag files" +
                       (compressed.empty() ? "" : "; `zstd -d " + compressed + "` decompresses one of them"));
    }
    // Natural order of the names: NAME_2 comes before NAME_10.
    std::sort(files.begin(), files.end(),
              [](const std::string& a, const std::string& b)
              { return std::make_pair(a.size(), a) < std::make_pair(b.size(), b); });
    for (const std::string& file : files)
    {
      parts_.push_back(open(file));
      for (const auto& [name, topic] : parts_.back()->topics())
      {
        topics_[name].type = topic.type;
        topics_[name].messages += topic.messages;
      }
      remark_ += (remark_.empty() || parts_.back()->remark().empty() ? "" : "; ") + parts_.back()->remark();
    }
  }

  void visit(const std::vector<std::string>& topics, bool with_temperatures, const Visit& visit,
             const Progress& progress) override
  {
    bool more = true;
    for (std::size_t i = 0; i < parts_.size() && more; ++i)
    {
      parts_[i]->visit(
          topics, with_temperatures, [&](const RecordedMessage& message) { return more = visit(message); },
          [&](double share) { progress((static_cast<double>(i) + share) / static_cast<double>(parts_.size())); });
    }
  }

private:
  std::vector<std::unique_ptr<RecordedMessages>> parts_;
};
}  // namespace

Stamp RecordedMessage::stamp() const
{
  const ros::Time none;
  const ros::Time& own = state != nullptr       ? state->header.stamp :
                         temperature != nullptr ? temperature->header.stamp :
                                                  none;
  return own.isZero() ? recorded : fromRosTime(own);
}

std::unique_ptr<RecordedMessages> RecordedMessages::open(const std::string& path)
{
  switch (formatOfRecording(path))
  {
    case RecordingFormat::DATABASE:
      return openDatabase(path);
    case RecordingFormat::MCAP:
      return openMcap(path);
    case RecordingFormat::DIRECTORY:
      return std::make_unique<DirectoryMessages>(path);
    case RecordingFormat::TABLE:
      throw InputError(path + " is a text, not a recording of ROS");
    case RecordingFormat::BAG:
      break;
  }
  return std::make_unique<BagMessages>(path);
}

std::uint64_t RecordedMessages::messagesOn(const std::string& topic) const
{
  const auto found = topics_.find(topic);
  return found == topics_.end() ? 0 : found->second.messages;
}

std::string RecordedMessages::listTopics() const
{
  std::string text;
  for (const auto& [name, topic] : topics_)
  {
    text += "\n  " + name + " (" + topic.type + ")";
  }
  return text.empty() ? " nothing" : text;
}

void RecordedMessages::requireStates(const std::string& topic) const
{
  if (messagesOn(topic) > 0)
  {
    return;
  }
  std::string others;
  for (const auto& [name, found] : topics_)
  {
    others += found.type == JOINT_STATE_TYPE && found.messages > 0 ? "; --topic " + name + " reads this topic" : "";
  }
  throw InputError(path_ + " has no messages on " + topic + "; it contains:" + listTopics() + others);
}
}  // namespace hjt
