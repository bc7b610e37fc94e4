// SPDX-License-Identifier: BSD-3-Clause
#include "bags/bag_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>

#include <console_bridge/console.h>
#include <rosbag/chunked_file.h>
#include <rosbag/constants.h>
#include <rosbag/view.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr std::string_view VERSION_LINE = "#ROSBAG V2.0\n";
// Largest size of a chunk after decompression [byte]. Chunks of rosbag itself have 0.75 MB.
constexpr std::uint32_t MAX_CHUNK = 1U << 28;

/// A damage of the file and its position [byte].
struct Damage
{
  std::uint64_t position;
  std::string what;
};

/// Calls `visit(name, value)` for every field of a header. @returns false if the length of a field is wrong.
template <class Visitor>
bool visitFields(std::string_view header, const Visitor& visit)
{
  while (!header.empty())
  {
    std::uint32_t length = 0;
    if (header.size() < sizeof(length))
    {
      return false;
    }
    std::memcpy(&length, header.data(), sizeof(length));
    header.remove_prefix(sizeof(length));
    const std::size_t equals = header.substr(0, length).find('=');
    if (length > header.size() || equals == std::string_view::npos)
    {
      return false;
    }
    visit(header.substr(0, equals), header.substr(equals + 1, length - equals - 1));
    header.remove_prefix(length);
  }
  return true;
}

struct Record
{
  std::uint64_t position{};  // position of the record in its stream [byte]
  std::string header;
  std::uint32_t size{};  // size of the data, which follow the header in the stream [byte]

  std::string_view text(const std::string& name) const
  {
    std::string_view found;
    visitFields(header,
                [&](std::string_view key, std::string_view value)
                {
                  if (key == name)
                  {
                    found = value;
                  }
                });
    return found;
  }

  template <class Number>
  Number number(const std::string& name) const
  {
    const std::string_view found = text(name);
    Number value{};
    if (found.size() != sizeof(value))
    {
      throw Damage{ position, "a record without a valid field '" + name + "'" };
    }
    std::memcpy(&value, found.data(), sizeof(value));
    return value;
  }

  unsigned char kind() const { return number<unsigned char>(rosbag::OP_FIELD_NAME); }
};

/// Iterates over the records of a file or of a chunk.
class Records
{
public:
  /// Begins at the present position of the stream. `end`: position after the last record [byte].
  Records(std::istream& stream, std::uint64_t end) : stream_(stream), next_(position()), end_(end) {}

  /// Reads the next record. @returns false if there is no further record.
  bool read(Record& record)
  {
    stream_.seekg(static_cast<std::streamoff>(next_));
    record.position = next_;
    if (next_ == end_)
    {
      return false;
    }
    record.header.resize(length(next_));
    stream_.read(record.header.data(), static_cast<std::streamsize>(record.header.size()));
    if (!visitFields(record.header, [](auto, auto) {}))
    {
      throw Damage{ next_, "a header with a wrong length" };
    }
    record.size = length(next_);
    next_ = position() + record.size;
    return true;
  }

  std::string data(const Record& record)
  {
    std::string bytes(record.size, '\0');
    stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return bytes;
  }

private:
  std::uint64_t position() { return static_cast<std::uint64_t>(stream_.tellg()); }

  /// Reads the next number, which is the number of bytes that follow it.
  std::uint32_t length(std::uint64_t record)
  {
    std::uint32_t count = 0;
    const std::uint64_t at = position();
    if (end_ - at < sizeof(count) || !stream_.read(reinterpret_cast<char*>(&count), sizeof(count)) ||
        end_ - at - sizeof(count) < count)
    {
      throw Damage{ record, "a record longer than the remaining file or chunk" };
    }
    return count;
  }

  std::istream& stream_;
  std::uint64_t next_;
  std::uint64_t end_;
};

class BagCheck
{
public:
  explicit BagCheck(const std::string& path) : file_(path, std::ios::binary), size_(std::filesystem::file_size(path))
  {
    std::string version(VERSION_LINE.size(), '\0');
    file_.read(version.data(), static_cast<std::streamsize>(version.size()));
    if (!file_ || version != VERSION_LINE)
    {
      throw Damage{ 0, "a first line other than that of bag format 2.0" };
    }
  }

  void run()
  {
    Records records(file_, size_);
    Record record;
    if (!records.read(record) || record.kind() != rosbag::OP_FILE_HEADER)
    {
      throw Damage{ record.position, "no header of a bag" };
    }
    const auto index = record.number<std::uint64_t>(rosbag::INDEX_POS_FIELD_NAME);
    if (index == 0 || !record.text(rosbag::ENCRYPTOR_FIELD_NAME).empty())
    {
      return;
    }
    while (records.read(record) && record.position < index)
    {
      checkChunkOrIndex(records, record);
    }
    if (record.position != index)
    {
      throw Damage{ index, "no index at the position that the header names" };
    }
    do
    {
      checkSummary(records, record);
    } while (records.read(record));
  }

private:
  void checkChunkOrIndex(Records& records, const Record& record)
  {
    if (record.kind() == rosbag::OP_CHUNK)
    {
      chunk_ = record.position;
      indexes_[chunk_] = 0;
      readChunk(record, records.data(record));
    }
    else if (record.kind() == rosbag::OP_INDEX_DATA && chunk_ != 0)
    {
      ++indexes_[chunk_];
      checkIndex(record, records.data(record));
    }
    else
    {
      chunk_ = 0;  // the rosbag library expects the index of a chunk directly after the chunk
    }
  }

  /// Finds the positions of the messages in a chunk.
  void readChunk(const Record& record, std::string bytes)
  {
    const auto size = record.number<std::uint32_t>(rosbag::SIZE_FIELD_NAME);
    const std::string_view compression = record.text(rosbag::COMPRESSION_FIELD_NAME);
    if (compression == rosbag::COMPRESSION_NONE ? size != bytes.size() : size > MAX_CHUNK)
    {
      throw Damage{ chunk_, "a chunk with another size than the size in its header" };
    }
    if (compression != rosbag::COMPRESSION_NONE)
    {
      std::string unpacked(size, '\0');
      unpacker_.decompress(compression == rosbag::COMPRESSION_BZ2 ? rosbag::compression::BZ2 : rosbag::compression::LZ4,
                           reinterpret_cast<std::uint8_t*>(unpacked.data()), size,
                           reinterpret_cast<std::uint8_t*>(bytes.data()), record.size);
      bytes.swap(unpacked);
    }
    std::istringstream stream(bytes);
    Records messages(stream, bytes.size());
    messages_.clear();
    try
    {
      for (Record message; messages.read(message);)
      {
        const unsigned char kind = message.kind();
        // An index entry must not point at these records, because the rosbag library then reads on to later records.
        if (kind != rosbag::OP_CONNECTION && kind != rosbag::OP_MSG_DEF)
        {
          messages_.push_back(message.position);
        }
      }
    }
    catch (const Damage& damage)
    {
      throw Damage{ chunk_, damage.what + ", " + std::to_string(damage.position) + " bytes into the chunk" };
    }
  }

  void checkIndex(const Record& record, const std::string& entries) const
  {
    constexpr std::size_t ENTRY = 12;  // time in seconds and nanoseconds, offset of the message [byte]
    constexpr std::size_t OFFSET = 8;
    requireSize(record, ENTRY);
    for (std::size_t at = 0; at < entries.size(); at += ENTRY)
    {
      std::uint32_t offset = 0;
      std::memcpy(&offset, entries.data() + at + OFFSET, sizeof(offset));
      if (!std::binary_search(messages_.begin(), messages_.end(), offset))
      {
        throw Damage{ record.position, "an index entry that points at no message" };
      }
    }
  }

  /// Checks the lengths of the connections, and whether each chunk has its index.
  void checkSummary(Records& records, const Record& record)
  {
    if (record.kind() == rosbag::OP_CONNECTION)
    {
      if (!visitFields(records.data(record), [](auto, auto) {}))
      {
        throw Damage{ record.position, "a connection with a wrong length" };
      }
    }
    else if (record.kind() == rosbag::OP_CHUNK_INFO)
    {
      constexpr std::size_t ENTRY = 8;  // numbers of a connection and of its messages in the chunk
      requireSize(record, ENTRY);
      const auto chunk = indexes_.find(record.number<std::uint64_t>(rosbag::CHUNK_POS_FIELD_NAME));
      if (chunk == indexes_.end() || chunk->second < record.size / ENTRY)
      {
        throw Damage{ record.position, "a chunk without its index" };
      }
    }
  }

  static void requireSize(const Record& record, std::size_t entry)
  {
    if (record.size != entry * std::uint64_t{ record.number<std::uint32_t>(rosbag::COUNT_FIELD_NAME) })
    {
      throw Damage{ record.position, "an index with another length than the length in its header" };
    }
  }

  std::ifstream file_;
  std::uint64_t size_;
  rosbag::ChunkedFile unpacker_;
  std::uint64_t chunk_{};                           // position of the chunk that the next index belongs to; 0: no chunk
  std::vector<std::uint64_t> messages_;             // positions of the messages in this chunk, ascending
  std::map<std::uint64_t, std::uint64_t> indexes_;  // number of index records of each chunk, by the chunk's position
};
}  // namespace

void checkBagFile(const std::string& path)
{
  try
  {
    BagCheck(path).run();
  }
  catch (const Damage& damage)
  {
    throw InputError(path + " cannot be read as a bag: " + damage.what + " at byte " + std::to_string(damage.position) +
                     "; `rosbag reindex` may repair a copy of it, for example if it was cut off");
  }
  catch (const std::exception& error)
  {
    throw InputError(path + " cannot be read as a bag: " + error.what());
  }
}

void openForReading(rosbag::Bag& bag, const std::string& path)
{
  checkBagFile(path);
  // Sets the same log level as BagWriter.
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
  try
  {
    bag.open(path, rosbag::bagmode::Read);
  }
  catch (const rosbag::BagUnindexedException&)
  {
    throw InputError(path + " was not closed properly and has no index; `rosbag reindex` may repair it");
  }
  catch (const std::exception& error)
  {
    throw InputError(path + " cannot be read as a bag: " + error.what());
  }
}

void refuseTopics(const rosbag::Bag& bag, const std::string& path, const std::vector<std::string>& topics)
{
  rosbag::View view(bag, rosbag::TopicQuery(topics));
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
  {
    throw InputError(path + " holds " + connection->topic +
                     " already; remove this topic from the bag, or choose another --joint-namespace");
  }
}

std::string listTopics(const rosbag::Bag& bag)
{
  std::map<std::string, std::string> types;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
  {
    types[connection->topic] = connection->datatype;
  }
  std::string text;
  for (const auto& [topic, type] : types)
  {
    text += "\n  " + topic + " (" + type + ")";
  }
  return text;
}
}  // namespace hjt
