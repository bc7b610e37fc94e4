// SPDX-License-Identifier: BSD-3-Clause
#include "run_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "bag_run_file.hpp"
#include "hdf5_run_file.hpp"

#include "harmonic_joint_twin/params/parameter_error.hpp"

namespace hjt
{
namespace
{
/// Brings a file's or a directory's content to the disk.
void synchronise(const std::string& path)
{
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && fsync(descriptor) == 0;
  const int reason = errno;
  if (descriptor >= 0)
  {
    close(descriptor);
  }
  if (!done)
  {
    throw InputError(path + " cannot be written: " + std::strerror(reason));
  }
}
}  // namespace

std::unique_ptr<RunFile> makeRunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                     const std::string& path)
{
  if (recording.format == RunFormat::BAG)
  {
    return std::make_unique<BagRunFile>(twin, path);
  }
  return std::make_unique<Hdf5RunFile>(recording, spec, twin, path);
}

const char* runFileExtension(RunFormat format)
{
  return format == RunFormat::BAG ? ".bag" : ".h5";
}

nlohmann::ordered_json readRunRecord(RunFormat format, const std::string& path)
{
  if (!std::filesystem::exists(path))
  {
    return nullptr;
  }
  const std::string text = format == RunFormat::BAG ? BagRunFile::readRecord(path) : Hdf5RunFile::readRecord(path);
  return nlohmann::ordered_json::parse(text, nullptr, false);
}

void writeTextFile(const std::string& path, const std::string& text)
{
  // Shards may write the same file at once: each has a temporary of its own.
  const std::string temporary = path + "." + std::to_string(std::random_device{}()) + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file)
  {
    throw InputError(temporary + " cannot be written: " + std::strerror(errno));
  }
  bringToDisk(temporary, path);
}

double dataSize(const Recording& recording, double duration, int teeth)
{
  double bytes = 0.0;
  for (const RecordingGroup& group : recording.groups)
  {
    for (const Column* column : group.columns)
    {
      const double numbers = column->per_tooth != nullptr ? teeth : 1;
      bytes += (duration - recording.start) * group.rate * numbers * (group.float32 ? 4.0 : 8.0);
    }
  }
  return bytes;
}

void bringToDisk(const std::string& temporary, const std::string& path)
{
  synchronise(temporary);
  if (std::rename(temporary.c_str(), path.c_str()) != 0)
  {
    throw InputError(path + " cannot be written: " + std::strerror(errno));
  }
  const std::string directory = std::filesystem::path(path).parent_path().string();
  synchronise(directory.empty() ? "." : directory);
}
}  // namespace hjt
