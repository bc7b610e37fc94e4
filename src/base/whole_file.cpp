// SPDX-License-Identifier: BSD-3-Clause
#include "base/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
struct Descriptor
{
  explicit Descriptor(int opened) : number(opened) {}
  ~Descriptor()
  {
    if (number >= 0)
    {
      close(number);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;

  const int number;
};

/// Flushes the content of a file or directory to the disk.
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

/// Writes to an open file and closes it. @throws InputError that names `path`.
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

/// Opens a new file beside `target` for writing. @throws InputError that names `path`, as the user wrote it.
int openBeside(const std::string& target, const std::string& path, mode_t mode, std::string& name)
{
  // Several processes may write the same file at once, so each needs a temporary file of its own.
  constexpr int TRIES = 10;
  for (int i = 0; i < TRIES; ++i)
  {
    std::random_device number;
    name = target + "." + std::to_string(number()) + std::to_string(number()) + ".part";
    const int descriptor = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (descriptor >= 0)
    {
      return descriptor;
    }
    if (errno != EEXIST)
    {
      break;
    }
  }
  throw InputError(path + " cannot be written: " + std::strerror(errno));
}

/// Renames a new file with these bytes to `target`. @throws InputError that names `path`, as the user wrote it.
void replaceFile(const std::string& path, const std::string& target, const std::string& bytes, mode_t mode)
{
  std::string temporary;
  const int descriptor = openBeside(target, path, mode, temporary);
  try
  {
    writeAll(descriptor, bytes, path);
    bringToDisk(temporary, target);
  }
  catch (const InputError&)
  {
    std::remove(temporary.c_str());
    throw;
  }
}

constexpr mode_t READABLE = 0666;  // the user's umask limits these rights
}  // namespace

std::optional<std::string> wholeFile(const std::string& path, std::size_t most, std::string* reason)
{
  const auto fail = [&](const std::string& why)
  {
    if (reason != nullptr)
    {
      *reason = why;
    }
    return std::nullopt;
  };
  // Without O_NONBLOCK, open() of a pipe without a writer blocks.
  const Descriptor file{ open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK) };
  struct stat status
  {
  };
  if (file.number < 0 || fstat(file.number, &status) != 0)
  {
    return fail(std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode))
  {
    return fail("it is a directory, a device or a pipe");
  }
  std::string text;
  for (;;)
  {
    constexpr std::size_t PIECE = 1U << 16;
    if (static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0)) > most || text.size() > most)
    {
      return fail("it is larger than " + std::to_string(most) + " bytes");
    }
    const std::size_t size = text.size();
    text.resize(size + PIECE);
    const ssize_t count = read(file.number, text.data() + size, PIECE);
    text.resize(size + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count == 0)
    {
      return text;
    }
    if (count < 0 && errno != EINTR)
    {
      return fail(std::strerror(errno));
    }
  }
}

std::string readFile(const std::string& path, std::size_t most)
{
  std::string reason;
  std::optional<std::string> bytes = wholeFile(path, most, &reason);
  if (!bytes)
  {
    throw InputError("'" + path + "' cannot be read: " + reason);
  }
  return std::move(*bytes);
}

void writeTextFile(const std::string& path, const std::string& text)
{
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const fs::path there = fs::canonical(path, error);  // path with all links resolved
  // The target of a link in /proc/self/fd may have no path.
  if (fs::exists(status) && (error || !fs::is_regular_file(status)))
  {
    const int descriptor = open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    writeAll(descriptor, text, path);
    return;
  }
  replaceFile(path, error ? path : there.string(), text, READABLE);
}

void writePrivateFile(const std::string& path, const std::string& bytes)
{
  replaceFile(path, path, bytes, S_IRUSR | S_IWUSR);
}

std::string makeFileBeside(const std::string& target)
{
  std::string name;
  close(openBeside(target, target, READABLE, name));
  return name;
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
