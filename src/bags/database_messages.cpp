// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include <sqlite3.h>

#include "bags/recording_format.hpp"
#include "bags/ros2_messages.hpp"
#include "base/temporary_directory.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
struct CloseDatabase
{
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};

struct EndStatement
{
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

namespace fs = std::filesystem;

/// The name of a file as SQLite reads it in a URI.
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
  /// Without writing beside it: SQLite makes files of its own for a recording in WAL mode (rosbag2's resilient preset),
  /// and mends what a recorder left when it was killed. With such files beside it a copy is read.
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

  /// With what lies beside it.
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

  /// A view in its place may have no end.
  void requireTable(const char* table) const
  {
    const auto found = prepare("SELECT type, COUNT(*) FROM sqlite_master WHERE name = ?1 COLLATE NOCASE");
    sqlite3_bind_text(found.get(), 1, table, -1, SQLITE_STATIC);
    if (!step(found) || text(found, 0) != "table")
    {
      throw InputError(path_ + " is a SQLite file without a table '" + table + "', so not a .db3 of ROS 2");
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

  std::optional<TemporaryDirectory> copy_;  // that is read in place of the file
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::map<std::int64_t, Ros2Channel> channels_;
};
}  // namespace

std::unique_ptr<RecordedMessages> openDatabase(const std::string& path)
{
  return std::make_unique<DatabaseMessages>(path);
}

}  // namespace hjt
