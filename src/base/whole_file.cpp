// SPDX-License-Identifier: BSD-3-Clause
#include "base/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "harmonic_joint_twin/base/errors.hpp"

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

void writeTextFile(const std::string& path, const std::string& text)
{
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path there = fs::canonical(path, error);  // the file behind links; none: it is new
  const std::string target = error ? path : there.string();
  const bool device = !error && !fs::is_regular_file(there, error);
  // Shards may write the same file at once: each has a temporary of its own.
  const std::string temporary = device ? target : target + "." + std::to_string(std::random_device{}()) + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file)
  {
    const int reason = errno;
    if (!device)
    {
      fs::remove(temporary, error);
    }
    throw InputError(path + " cannot be written: " + std::strerror(reason));
  }
  if (!device)
  {
    bringToDisk(temporary, target);
  }
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
