// SPDX-License-Identifier: BSD-3-Clause
#include "base/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <utility>

#include "base/text_stream.hpp"
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

/// Writes to a file that was opened, and closes it. `path`: named in the error. @throws InputError.
void writeAll(int descriptor, const std::string& bytes, const std::string& path)
{
  bool good = descriptor >= 0;
  for (std::size_t done = 0; good && done < bytes.size();)
  {
    const ssize_t written = write(descriptor, bytes.data() + done, bytes.size() - done);
    good = written >= 0 || errno == EINTR;
    done += written > 0 ? static_cast<std::size_t>(written) : 0;
  }
  const int reason = errno;
  const bool closed = descriptor >= 0 && close(descriptor) == 0;
  if (!good || !closed)
  {
    throw InputError(path + " cannot be written: " + std::strerror(good ? errno : reason));
  }
}

/// Gives the name `target` to a new file. `path`: as the user named it.
void replaceFile(const std::string& path, const std::string& target, const std::string& bytes, mode_t mode)
{
  // Shards may write the same file at once: each has a temporary of its own.
  const std::string temporary = target + "." + std::to_string(std::random_device{}()) + ".part";
  const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  try
  {
    writeAll(descriptor, bytes, path);
    bringToDisk(temporary, target);
  }
  catch (const InputError&)
  {
    if (descriptor >= 0)
    {
      std::remove(temporary.c_str());
    }
    throw;
  }
}
}  // namespace

std::optional<std::string> wholeFile(const std::string& path)
{
  const std::ifstream file(path, std::ios::binary);
  TextStream bytes;
  bytes << file.rdbuf();  // fails where there are none, and where reading ends with an error
  std::string text = bytes.str();
  return file && (bytes || text.empty()) ? std::optional(std::move(text)) : std::nullopt;
}

std::string readFile(const std::string& path)
{
  std::optional<std::string> bytes = wholeFile(path);
  if (!bytes)
  {
    throw InputError("'" + path + "' cannot be read");
  }
  return std::move(*bytes);
}

void writeTextFile(const std::string& path, const std::string& text)
{
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const fs::path there = fs::canonical(path, error);  // behind links
  // What links of /proc/self/fd lead to may have no name.
  if (fs::exists(status) && (error || !fs::is_regular_file(status)))
  {
    const int descriptor = open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    writeAll(descriptor, text, path);
    return;
  }
  constexpr mode_t READABLE = 0666;  // as the user's mask allows
  replaceFile(path, error ? path : there.string(), text, READABLE);
}

void writePrivateFile(const std::string& path, const std::string& bytes)
{
  replaceFile(path, path, bytes, S_IRUSR | S_IWUSR);
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
