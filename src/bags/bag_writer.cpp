// SPDX-License-Identifier: BSD-3-Clause
#include "bags/bag_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace hjt
{
namespace
{
using Bytes = std::vector<std::uint8_t>;

constexpr char VERSION[] = "#ROSBAG V2.0\n";
constexpr std::size_t FILE_HEADER_SIZE = 4096;  // with padding; `close` writes the header again in this space [byte]
constexpr std::size_t CHUNK_THRESHOLD = 768 * 1024;  // the message that exceeds this size ends a chunk [byte]

enum class Operation : std::uint8_t
{
  MESSAGE = 2,
  FILE_HEADER = 3,
  INDEX = 4,
  CHUNK = 5,
  CHUNK_INFO = 6,
  CONNECTION = 7
};

void put(Bytes& out, const void* bytes, std::size_t size)
{
  const auto* first = static_cast<const std::uint8_t*>(bytes);
  out.insert(out.end(), first, first + size);
}

template <class Number>
void put(Bytes& out, Number number)
{
  static_assert(std::is_integral_v<Number>);
  put(out, &number, sizeof(number));  // little-endian, as in ROS messages
}

void put(Bytes& out, const ros::Time& time)
{
  put(out, time.sec);
  put(out, time.nsec);
}

void put(Bytes& out, const std::string& text)
{
  put(out, text.data(), text.size());
}

void put(Bytes& out, Operation operation)
{
  put(out, static_cast<std::uint8_t>(operation));
}

/// Writes the fields of a record's header, each with its length.
class HeaderFields
{
public:
  explicit HeaderFields(Bytes& out) : out_(out), begin_(out.size()) { put(out_, std::uint32_t{}); }

  template <class Value>
  HeaderFields& add(const std::string& name, const Value& value)
  {
    const std::size_t field = out_.size();
    put(out_, std::uint32_t{});
    put(out_, name);
    out_.push_back('=');
    put(out_, value);
    putLength(field);
    return *this;
  }

  /// Writes the length of the header before its fields. @returns the length including its own four bytes [byte].
  std::size_t finish()
  {
    putLength(begin_);
    return out_.size() - begin_;
  }

private:
  void putLength(std::size_t place)
  {
    const auto length = static_cast<std::uint32_t>(out_.size() - place - sizeof(std::uint32_t));
    std::memcpy(out_.data() + place, &length, sizeof(length));
  }

  Bytes& out_;
  std::size_t begin_;
};

void putConnection(Bytes& out, std::uint32_t number, const std::string& topic, const ros::M_string& header)
{
  HeaderFields(out).add("conn", number).add("op", Operation::CONNECTION).add("topic", topic).finish();
  HeaderFields fields(out);
  for (const auto& [name, value] : header)
  {
    fields.add(name, value);
  }
  fields.finish();
}
}  // namespace

BagWriter::BagWriter(std::string path)
  : path_(std::move(path))
  , active_path_(path_ + ".active")
  , lock_(active_path_)
  , file_(std::fopen(active_path_.c_str(), "wb"), &std::fclose)
{
  if (!file_)
  {
    throw InputError(path_ + " cannot be written: " + std::strerror(errno));
  }
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // without a buffer, because each write is large
  Bytes version;
  put(version, VERSION, sizeof(VERSION) - 1);
  flush(version);
  writeFileHeader(0);
}

BagWriter::~BagWriter()
{
  try
  {
    close();
  }
  catch (const InputError&)
  {
    // A destructor cannot report an error.
  }
}

/// Converts a message's stamp to its time of recording. @throws InputError if the bag is closed or the stamp is zero.
ros::Time BagWriter::begin(Stamp stamp)
{
  if (!file_)
  {
    throw InputError(path_ + " cannot be written, because it is closed");
  }
  const ros::Time time = toRosTime(stamp);
  if (time < ros::TIME_MIN)
  {
    giveUp("a message at time 0, which a bag cannot hold");
  }
  return time;
}

void BagWriter::copy(const rosbag::MessageInstance& message)
{
  // First the message is read, because an error of reading would otherwise leave an incomplete record in the chunk.
  scratch_.resize(message.size());
  ros::serialization::OStream stream(scratch_.data(), static_cast<std::uint32_t>(scratch_.size()));
  message.write(stream);
  const ros::Time time = begin(fromRosTime(message.getTime()));
  const boost::shared_ptr<ros::M_string> header = message.getConnectionHeader();
  auto known = copied_headers_.find(header);
  if (known == copied_headers_.end())
  {
    // The headers of two connections may be equal, so the key also contains the topic.
    ros::M_string key = *header;
    key["topic"] = message.getTopic();
    auto same = copied_.find(key);
    if (same == copied_.end())
    {
      same = copied_.emplace(std::move(key), connect(message.getTopic(), *header)).first;
    }
    known = copied_headers_.emplace(header, same->second).first;
  }
  std::copy(scratch_.begin(), scratch_.end(), append(known->second, time, static_cast<std::uint32_t>(scratch_.size())));
  end();
}

/// Makes a connection for a topic. @returns the number of the connection.
std::uint32_t BagWriter::connect(const std::string& topic, const ros::M_string& header)
{
  const auto number = static_cast<std::uint32_t>(connections_.size());
  connections_.push_back({ topic, header, {} });
  putConnection(chunk_, number, topic, header);
  return number;
}

/// Appends the record of a message without its data. @returns the place for the `size` bytes of the data.
std::uint8_t* BagWriter::append(std::uint32_t connection, const ros::Time& time, std::uint32_t size)
{
  std::vector<IndexEntry>& index = connections_[connection].index;
  const bool is_first = running_.first.isZero();
  running_.first = is_first ? time : std::min(running_.first, time);
  running_.last = is_first ? time : std::max(running_.last, time);
  index.push_back({ time, static_cast<std::uint32_t>(chunk_.size()) });
  HeaderFields(chunk_).add("conn", connection).add("op", Operation::MESSAGE).add("time", time).finish();
  put(chunk_, size);
  const std::size_t place = chunk_.size();
  chunk_.resize(place + size);
  return chunk_.data() + place;
}

void BagWriter::end()
{
  ++messages_;
  if (chunk_.size() > CHUNK_THRESHOLD)
  {
    writeChunk();
  }
}

/// Writes the present chunk and the index of the chunk's messages.
void BagWriter::writeChunk()
{
  running_.position = position_;
  const auto size = static_cast<std::uint32_t>(chunk_.size());
  Bytes header;
  HeaderFields(header).add("compression", std::string("none")).add("op", Operation::CHUNK).add("size", size).finish();
  put(header, size);
  Bytes index;
  for (std::uint32_t number = 0; number < connections_.size(); ++number)
  {
    std::vector<IndexEntry>& entries = connections_[number].index;
    if (entries.empty())
    {
      continue;
    }
    const auto count = static_cast<std::uint32_t>(entries.size());
    std::stable_sort(entries.begin(), entries.end(),
                     [](const IndexEntry& a, const IndexEntry& b) { return a.time < b.time; });
    HeaderFields(index)
        .add("conn", number)
        .add("count", count)
        .add("op", Operation::INDEX)
        .add("ver", std::uint32_t{ 1 })
        .finish();
    put(index, static_cast<std::uint32_t>(count * (sizeof(ros::Time) + sizeof(std::uint32_t))));
    for (const IndexEntry& entry : entries)
    {
      put(index, entry.time);
      put(index, entry.offset);
    }
    running_.counts.emplace_back(number, count);
    entries.clear();
  }
  flush(header);
  flush(chunk_);
  flush(index);
  chunk_.clear();
  chunks_.push_back(std::exchange(running_, {}));
}

/// Writes the file's header at the present position. `index_position`: position after the chunks; 0: not yet known.
void BagWriter::writeFileHeader(std::uint64_t index_position)
{
  Bytes out;
  const std::size_t size = HeaderFields(out)
                               .add("chunk_count", static_cast<std::uint32_t>(chunks_.size()))
                               .add("conn_count", static_cast<std::uint32_t>(connections_.size()))
                               .add("index_pos", index_position)
                               .add("op", Operation::FILE_HEADER)
                               .finish();
  const auto padding = static_cast<std::uint32_t>(FILE_HEADER_SIZE - (size - sizeof(std::uint32_t)));
  put(out, padding);
  out.resize(out.size() + padding, ' ');
  flush(out);
}

void BagWriter::flush(const Bytes& bytes)
{
  if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
  {
    giveUp(std::strerror(errno));
  }
  position_ += bytes.size();
}

void BagWriter::close()
{
  if (!file_)
  {
    return;
  }
  if (!chunk_.empty())
  {
    writeChunk();
  }
  const std::uint64_t index_position = position_;
  Bytes out;
  for (std::uint32_t number = 0; number < connections_.size(); ++number)
  {
    putConnection(out, number, connections_[number].topic, connections_[number].header);
  }
  for (const ChunkInfo& chunk : chunks_)
  {
    HeaderFields(out)
        .add("chunk_pos", chunk.position)
        .add("count", static_cast<std::uint32_t>(chunk.counts.size()))
        .add("end_time", chunk.last)
        .add("op", Operation::CHUNK_INFO)
        .add("start_time", chunk.first)
        .add("ver", std::uint32_t{ 1 })
        .finish();
    put(out, static_cast<std::uint32_t>(chunk.counts.size() * 2 * sizeof(std::uint32_t)));
    for (const auto& [connection, count] : chunk.counts)
    {
      put(out, connection);
      put(out, count);
    }
  }
  flush(out);
  if (std::fseek(file_.get(), sizeof(VERSION) - 1, SEEK_SET) != 0)
  {
    giveUp(std::strerror(errno));
  }
  writeFileHeader(index_position);
  if (std::fclose(file_.release()) != 0)
  {
    giveUp(std::strerror(errno));
  }
  std::error_code error;
  if (messages_ > 0)
  {
    std::filesystem::rename(active_path_, path_, error);
  }
  else
  {
    std::filesystem::remove(active_path_, error);
  }
  if (error)
  {
    throw InputError(path_ + " cannot be written: " + error.message());
  }
}

void BagWriter::giveUp(const std::string& reason)
{
  file_.reset();
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(active_path_, unknown);
  throw InputError(path_ + " cannot be written: " + reason + "; " + active_path_ + " has " + std::to_string(size) +
                   " bytes of " + std::to_string(messages_) +
                   " messages: `rosbag reindex` makes all but the last 0.8 MB readable");
}
}  // namespace hjt
