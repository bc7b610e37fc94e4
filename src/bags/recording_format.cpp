// SPDX-License-Identifier: BSD-3-Clause
#include "bags/recording_format.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "harmonic_joint_twin/base/errors.hpp"

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
    { "#ROSBAG V1"sv, "a bag of format 1; `rosbag fix` of ROS 1 makes one of format 2.0 of it" },
    { "\x28\xB5\x2F\xFD"sv, "compressed by zstd; `zstd -d FILE` unpacks it" },
    { "\x1F\x8B"sv, "compressed by gzip; `gunzip FILE` unpacks it" },
    { "BZh"sv, "compressed by bzip2; `bunzip2 FILE` unpacks it" },
    { "\xFD"
      "7zXZ"sv,
      "compressed by xz; `unxz FILE` unpacks it" },
    { "PK\x03\x04"sv, "a zip archive or a spreadsheet (.zip, .xlsx, .npz); save its table as CSV" },
    { "\x89HDF"sv, "an HDF5 file; save its table as CSV" },
    { "MATLAB 5.0"sv, "a MATLAB file; writetable saves its table as CSV" },
    { "PAR1"sv, "a Parquet file; save its table as CSV" },
    { "\xFF\xFE"sv, "a text in UTF-16; `iconv -f UTF-16 -t UTF-8 FILE` makes one in UTF-8 of it" },
    { "\xFE\xFF"sv, "a text in UTF-16; `iconv -f UTF-16 -t UTF-8 FILE` makes one in UTF-8 of it" },
    { "ULog"sv, "a PX4 log; ulog2csv makes CSV of it" },
} };
}  // namespace

std::string conversionOf(const std::string& path)
{
  return "`rosbags-convert --src " + path + " --dst " + std::filesystem::path(path).stem().string() +
         ".bag` (pip install rosbags) makes a bag of it";
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
    throw InputError(path + " is empty: no byte was recorded");
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
                     (is_named_bag ? " cannot be read as a bag: no bag of format 2.0 at byte 0" :
                                     " is neither a recording of ROS nor a table of text") +
                     "; what is read is a bag, a .db3 or .mcap file of ROS 2, and CSV");
  }
  return RecordingFormat::TABLE;
}

void requireTable(const std::string& path, const std::string& wanted)
{
  if (std::filesystem::is_regular_file(path) && formatOfRecording(path) != RecordingFormat::TABLE)
  {
    throw InputError(path + " holds messages, which have no targets: " + wanted);
  }
}
}  // namespace hjt
