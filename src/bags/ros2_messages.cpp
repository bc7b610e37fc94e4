// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include "bags/message_decoder.hpp"
#include "bags/recorded_messages.hpp"
#include "base/temporary_directory.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
/// Converts a type to the spelling of ROS 1: "sensor_msgs/msg/JointState" becomes "sensor_msgs/JointState".
std::string ros1Type(const std::string& type)
{
  const std::string middle = "/msg/";
  const std::size_t at = type.find(middle);
  return at == std::string::npos ? type : type.substr(0, at + 1) + type.substr(at + middle.size());
}

struct Ros2Channel
{
  std::string topic;
  std::string type;
  MessageEncoding encoding{};
  bool is_chosen{};
};

/// Whether a channel is on a chosen topic. @throws InputError if the type of a chosen topic is not JointState.
bool isChosen(const Ros2Channel& channel, const std::vector<std::string>& topics, bool with_temperatures)
{
  const bool is_named = std::find(topics.begin(), topics.end(), channel.topic) != topics.end();
  if (is_named && channel.type != JOINT_STATE_TYPE)
  {
    throw InputError(channel.topic + " has type " + channel.type + ", expected " + JOINT_STATE_TYPE);
  }
  return is_named || (with_temperatures && channel.type == TEMPERATURE_TYPE);
}

/// Decodes the messages of chosen channels and gives them to the visitor. `take` returns false if the visitor stops.
class Ros2Message
{
public:
  explicit Ros2Message(const RecordedMessages::Visit& visit) : visit_(visit) {}

  bool take(const Ros2Channel& channel, Stamp recorded, const std::vector<std::uint8_t>& bytes)
  {
    RecordedMessage message{ channel.topic, recorded, {} };
    if (channel.type == TEMPERATURE_TYPE)
    {
      message.temperature = decode(bytes, channel.encoding, temperature_) ? &temperature_ : nullptr;
    }
    else
    {
      message.state = decode(bytes, channel.encoding, state_) ? &state_ : nullptr;
    }
    return visit_(message);
  }

private:
  const RecordedMessages::Visit& visit_;
  sensor_msgs::JointState state_;
  sensor_msgs::Temperature temperature_;
};

struct CloseDatabase
{
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};

struct EndStatement
{
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

namespace fs = std::filesystem;

std::string uriOf(const std::string& path)
{
  std::string uri = "file:";
  for (const char c : fs::absolute(path).string())
  {
    std::array<char, 4> code{};
    std::snprintf(code.data(), code.size(), "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    uri += c == '%' || c == '?' || c == '#' ? code.data() : std::string(1, c);
  }
  return uri;
}

class DatabaseMessages : public RecordedMessages
{
public:
  explicit DatabaseMessages(const std::string& path) : RecordedMessages(path)
  {
    openFile();
    requireTable("topics");
    requireTable("messages");
    const auto topics = prepare("SELECT id, name, type, serialization_format FROM topics");
    while (step(topics))
    {
      Ros2Channel channel{ text(topics, 1), ros1Type(text(topics, 2)), encodingOf(text(topics, 3)), false };
      topics_[channel.topic].type = channel.type;
      channels_[sqlite3_column_int64(topics.get(), 0)] = std::move(channel);
    }
    const auto counts = prepare("SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id");
    while (step(counts))
    {
      const auto channel = channels_.find(sqlite3_column_int64(counts.get(), 0));
      if (channel != channels_.end())
      {
        topics_[channel->second.topic].messages += static_cast<std::uint64_t>(sqlite3_column_int64(counts.get(), 1));
      }
    }
  }

  void visit(const std::vector<std::string>& topics, bool with_temperatures, const Visit& visit,
             const Progress& progress) override
  {
    double total = 0.0;
    for (auto& [id, channel] : channels_)
    {
      channel.is_chosen = isChosen(channel, topics, with_temperatures);
      total += static_cast<double>(messagesOn(channel.topic));
    }
    Ros2Message message(visit);
    const auto rows = prepare("SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp, id");
    std::vector<std::uint8_t> bytes;
    for (double done = 1.0; step(rows); ++done)
    {
      const auto channel = channels_.find(sqlite3_column_int64(rows.get(), 0));
      if (channel == channels_.end() || !channel->second.is_chosen)
      {
        continue;
      }
      const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(rows.get(), 2));
      bytes.assign(data, data + (data == nullptr ? 0 : sqlite3_column_bytes(rows.get(), 2)));
      if (!message.take(channel->second, sqlite3_column_int64(rows.get(), 1), bytes))
      {
        return;
      }
      progress(done / total);
    }
  }

private:
  /// Opens the file without writing into its folder. SQLite writes additional files there for a recording in WAL mode
  /// (rosbag2's resilient preset), and repairs the file of a recorder that was killed. In these cases, a copy is read.
  void openFile()
  {
    bool is_clean = true;
    for (const char* ending : { "-wal", "-journal" })
    {
      std::error_code error;
      const std::uintmax_t size = fs::file_size(path_ + ending, error);
      is_clean = is_clean && (error || size == 0);
    }
    std::string name = uriOf(path_) + "?immutable=1";
    int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
    if (!is_clean)
    {
      name = copied();
      flags = SQLITE_OPEN_READWRITE;
    }
    sqlite3* database = nullptr;
    const int result = sqlite3_open_v2(name.c_str(), &database, flags, nullptr);
    database_.reset(database);
    if (result != SQLITE_OK)
    {
      fail();
    }
  }

  /// Copies the file with the additional files of SQLite.
  std::string copied()
  {
    const std::string copy = (fs::path(copy_.emplace().path()) / "copy.db3").string();
    for (const char* ending : { "", "-wal", "-journal" })
    {
      std::error_code error;
      if (fs::is_regular_file(path_ + ending, error))
      {
        fs::copy_file(path_ + ending, copy + ending, error);
      }
      if (error && fs::exists(path_ + ending))
      {
        throw InputError(path_ + ending + " cannot be copied to " + copy_->path() + ": " + error.message());
      }
    }
    return copy;
  }

  /// Throws if there is no table of this name. A view of this name does not count, because its rows may have no end.
  void requireTable(const char* table) const
  {
    const auto found = prepare("SELECT type, COUNT(*) FROM sqlite_master WHERE name = ?1 COLLATE NOCASE");
    sqlite3_bind_text(found.get(), 1, table, -1, SQLITE_STATIC);
    if (!step(found) || text(found, 0) != "table")
    {
      throw InputError(path_ + " is a SQLite file without the table '" + table +
                       "' and therefore not a .db3 file of ROS 2");
    }
  }

  using Statement = std::unique_ptr<sqlite3_stmt, EndStatement>;

  [[noreturn]] void fail() const
  {
    throw InputError(path_ + " is a SQLite file and cannot be read as a .db3 of ROS 2: " +
                     sqlite3_errmsg(database_.get()) + "; if ROS 2 reads it, " + conversionOf(path_));
  }

  Statement prepare(const char* query) const
  {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), query, -1, &statement, nullptr) != SQLITE_OK)
    {
      fail();
    }
    return Statement(statement);
  }

  bool step(const Statement& statement) const
  {
    const int result = sqlite3_step(statement.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE)
    {
      fail();
    }
    return result == SQLITE_ROW;
  }

  static std::string text(const Statement& statement, int column)
  {
    const auto* text = sqlite3_column_text(statement.get(), column);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
  }

  std::optional<TemporaryDirectory> copy_;  // the copy that is read in place of the file
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::map<std::int64_t, Ros2Channel> channels_;
};
}  // namespace

std::unique_ptr<RecordedMessages> openDatabase(const std::string& path)
{
  return std::make_unique<DatabaseMessages>(path);
}

namespace
{
using Bytes = std::vector<std::uint8_t>;

// By https://mcap.dev/spec, a record is an opcode, a length and the content, all of them little-endian.
enum Opcode : std::uint8_t
{
  FOOTER = 0x02,
  SCHEMA = 0x03,
  CHANNEL = 0x04,
  MESSAGE = 0x05,
  CHUNK = 0x06,
  DATA_END = 0x0F
};

constexpr std::size_t MAGIC = 8;                    // length of the mark at the begin and end of an MCAP file [byte]
constexpr std::size_t RECORD_HEAD = 9;              // length of opcode and length of a record [byte]
constexpr std::uint64_t MAX_MCAP_CHUNK = 1U << 30;  // largest size of an unpacked chunk [byte]
constexpr std::uint64_t SMALL_CHUNK = 1U << 26;     // unpacked chunks of this size are always accepted [byte]
constexpr std::uint64_t MOST_PACKED = 100;          // largest unpacked size of larger chunks over the file's size [-]

struct McapDamage
{
  std::string what;
};

/// Extracts the fields of a record one after the other. @throws McapDamage beyond the end of the record.
class Fields
{
public:
  Fields(const std::uint8_t* begin, std::size_t size) : at_(begin), left_(size) {}

  template <class Number>
  Number number()
  {
    Number value{};
    std::memcpy(&value, take(sizeof(value)), sizeof(value));
    return value;
  }

  std::string text()
  {
    const auto length = number<std::uint32_t>();
    return std::string(reinterpret_cast<const char*>(take(length)), length);
  }

  const std::uint8_t* take(std::size_t count)
  {
    if (count > left_)
    {
      throw McapDamage{ "a record that is shorter than its fields" };
    }
    const std::uint8_t* taken = at_;
    at_ += count;
    left_ -= count;
    return taken;
  }

  std::size_t left() const { return left_; }

private:
  const std::uint8_t* at_;
  std::size_t left_;
};

Bytes unpackedLz4(const std::uint8_t* data, std::size_t size, std::size_t unpacked_size)
{
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0)
  {
    throw McapDamage{ "not enough memory for a chunk" };
  }
  Bytes unpacked(unpacked_size);
  std::size_t written = 0;
  std::size_t read = 0;
  std::size_t hint = 1;
  while (hint != 0 && LZ4F_isError(hint) == 0 && read < size)
  {
    std::size_t room = unpacked.size() - written;
    std::size_t left = size - read;
    hint = LZ4F_decompress(context, unpacked.data() + written, &room, data + read, &left, nullptr);
    written += room;
    read += left;
    if (room == 0 && left == 0)
    {
      break;
    }
  }
  LZ4F_freeDecompressionContext(context);
  if (hint != 0 || written != unpacked.size())
  {
    throw McapDamage{ "a chunk that lz4 does not unpack" };
  }
  return unpacked;
}

Bytes unpackedZstd(const std::uint8_t* data, std::size_t size, std::size_t unpacked_size)
{
  Bytes unpacked(unpacked_size);
  if (ZSTD_decompress(unpacked.data(), unpacked.size(), data, size) != unpacked.size())
  {
    throw McapDamage{ "a chunk that zstd does not unpack" };
  }
  return unpacked;
}

class McapMessages : public RecordedMessages
{
public:
  explicit McapMessages(const std::string& path) : RecordedMessages(path)
  {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    size_ = static_cast<std::uint64_t>(file.tellg());
    readAll([](const Ros2Channel&, Stamp, const std::uint8_t*, std::size_t) { return true; },
            [this](const Ros2Channel& channel) { ++topics_[channel.topic].messages; }, [](double) {});
    if (topics_.empty())
    {
      throw InputError(path + " is an MCAP file without a message" + (remark_.empty() ? "" : ": " + remark_) +
                       "; if ROS 2 reads it, " + conversionOf(path));
    }
  }

  void visit(const std::vector<std::string>& topics, bool with_temperatures, const Visit& visit,
             const Progress& progress) override
  {
    for (auto& [id, channel] : channels_)
    {
      channel.is_chosen = isChosen(channel, topics, with_temperatures);
    }
    Ros2Message message(visit);
    Bytes bytes;
    readAll(
        [&](const Ros2Channel& channel, Stamp recorded, const std::uint8_t* data, std::size_t size)
        {
          if (!channel.is_chosen)
          {
            return true;
          }
          bytes.assign(data, data + size);
          return message.take(channel, recorded, bytes);
        },
        [](const Ros2Channel&) {}, progress);
  }

private:
  using Take = std::function<bool(const Ros2Channel&, Stamp, const std::uint8_t*, std::size_t)>;
  using Count = std::function<void(const Ros2Channel&)>;

  /// Reads all records up to the first damaged or truncated record.
  void readAll(const Take& take, const Count& count, const Progress& progress)
  {
    std::ifstream file(path_, std::ios::binary);
    file.seekg(MAGIC);
    std::uint64_t at = MAGIC;
    Bytes record;
    remark_.clear();
    try
    {
      for (;;)
      {
        std::array<std::uint8_t, RECORD_HEAD> head{};
        file.read(reinterpret_cast<char*>(head.data()), RECORD_HEAD);
        std::uint64_t length = 0;
        std::memcpy(&length, head.data() + 1, sizeof(length));
        if (!file || length > size_ - at - RECORD_HEAD)
        {
          throw McapDamage{ "the file was not closed" };
        }
        if (head[0] == DATA_END || head[0] == FOOTER)
        {
          return;
        }
        record.resize(length);
        file.read(reinterpret_cast<char*>(record.data()), static_cast<std::streamsize>(length));
        if (!takeRecord(head[0], Fields(record.data(), record.size()), false, take, count))
        {
          return;
        }
        at += RECORD_HEAD + length;
        progress(static_cast<double>(at) / static_cast<double>(size_));
      }
    }
    catch (const McapDamage& damage)
    {
      remark_ = path_ + " could be read up to byte " + std::to_string(at) + " of " + std::to_string(size_) + ": " +
                damage.what;
    }
  }

  /// Reads a record. A chunk within a chunk is rejected, because both chunks would be in memory at the same time.
  bool takeRecord(std::uint8_t opcode, Fields fields, bool is_in_chunk, const Take& take, const Count& count)
  {
    switch (opcode)
    {
      case SCHEMA:
      {
        const auto id = fields.number<std::uint16_t>();
        schemas_[id] = ros1Type(fields.text());
        return true;
      }
      case CHANNEL:
        addChannel(fields);
        return true;
      case MESSAGE:
        return takeMessage(fields, take, count);
      case CHUNK:
        if (is_in_chunk)
        {
          throw McapDamage{ "a chunk within a chunk" };
        }
        return takeChunk(fields, take, count);
      default:
        return true;
    }
  }

  void addChannel(Fields& fields)
  {
    const auto id = fields.number<std::uint16_t>();
    const auto schema = fields.number<std::uint16_t>();
    Ros2Channel& channel = channels_[id];
    channel.topic = fields.text();
    channel.type = schemas_[schema];
    channel.encoding = encodingOf(fields.text());
    topics_[channel.topic].type = channel.type;
  }

  bool takeMessage(Fields& fields, const Take& take, const Count& count)
  {
    const auto channel = channels_.find(fields.number<std::uint16_t>());
    fields.number<std::uint32_t>();  // sequence
    const auto recorded = static_cast<Stamp>(fields.number<std::uint64_t>());
    fields.number<std::uint64_t>();  // time of publication
    if (channel == channels_.end())
    {
      return true;
    }
    count(channel->second);
    const std::size_t size = fields.left();
    return take(channel->second, recorded, fields.take(size), size);
  }

  bool takeChunk(Fields& fields, const Take& take, const Count& count)
  {
    fields.take(2 * sizeof(std::uint64_t));  // times of the first and last message
    const auto unpacked_size = fields.number<std::uint64_t>();
    fields.take(sizeof(std::uint32_t));  // check sum
    const std::string compression = fields.text();
    const auto size = fields.number<std::uint64_t>();
    const std::uint8_t* data = fields.take(size);
    if (unpacked_size > std::min(MAX_MCAP_CHUNK, std::max(SMALL_CHUNK, MOST_PACKED * size_)))
    {
      throw McapDamage{ "a chunk of " + std::to_string(unpacked_size) + " bytes" };
    }
    Bytes unpacked;
    if (compression == "lz4")
    {
      unpacked = unpackedLz4(data, size, unpacked_size);
    }
    else if (compression == "zstd")
    {
      unpacked = unpackedZstd(data, size, unpacked_size);
    }
    else if (compression.empty())
    {
      unpacked.assign(data, data + size);
    }
    else
    {
      throw McapDamage{ "a chunk compressed by " + compression + "; `mcap compress` recompresses it by zstd" };
    }
    Fields records(unpacked.data(), unpacked.size());
    while (records.left() > 0)
    {
      const auto opcode = records.number<std::uint8_t>();
      const auto length = records.number<std::uint64_t>();
      if (!takeRecord(opcode, Fields(records.take(length), length), true, take, count))
      {
        return false;
      }
    }
    return true;
  }

  std::uint64_t size_{};
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Ros2Channel> channels_;
};
}  // namespace

std::unique_ptr<RecordedMessages> openMcap(const std::string& path)
{
  return std::make_unique<McapMessages>(path);
}
}  // namespace hjt
