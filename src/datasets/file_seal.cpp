// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/file_seal.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <string_view>

#include "base/hash.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t DIGITS = 16;

/// A whole file, mapped to memory.
class FileView
{
public:
  explicit FileView(const std::string& path) : file_(open(path.c_str(), O_RDONLY | O_CLOEXEC))
  {
    struct stat status
    {
    };
    if (file_ >= 0 && fstat(file_, &status) == 0 && status.st_size > 0)
    {
      size_ = static_cast<std::size_t>(status.st_size);
      start_ = mmap(nullptr, size_, PROT_READ, MAP_SHARED, file_, 0);
    }
  }
  ~FileView()
  {
    if (start_ != MAP_FAILED)
    {
      munmap(start_, size_);
    }
    if (file_ >= 0)
    {
      close(file_);
    }
  }
  FileView(const FileView&) = delete;
  FileView& operator=(const FileView&) = delete;

  /// Content of the file; empty if it cannot be read.
  std::string_view bytes() const
  {
    return start_ == MAP_FAILED ? std::string_view() : std::string_view(static_cast<const char*>(start_), size_);
  }

private:
  int file_;
  std::size_t size_{};
  void* start_{ MAP_FAILED };
};

/// Position of the seal's first digit; the size of the file if there is no seal.
std::size_t sealPlace(std::string_view bytes)
{
  const std::string before = '"' + std::string(FILE_HASH) + "\":\"";
  const std::size_t found = bytes.find(before);
  const std::size_t place = found + before.size();
  return found == std::string_view::npos || place + DIGITS > bytes.size() ? bytes.size() : place;
}

/// Hash of the bytes, computed with zeros in place of the seal's digits.
std::string hashOf(std::string_view bytes, std::size_t seal)
{
  const std::uint64_t before = textHash(bytes.substr(0, seal));
  char digits[DIGITS + 1];
  std::snprintf(digits, sizeof(digits), "%016llx",
                static_cast<unsigned long long>(textHash(bytes.substr(seal + DIGITS), textHash(OPEN_SEAL, before))));
  return digits;
}
}  // namespace

void sealFile(const std::string& path)
{
  const FileView view(path);
  const std::size_t seal = sealPlace(view.bytes());
  const std::string hash = seal < view.bytes().size() ? hashOf(view.bytes(), seal) : "";
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  const bool written =
      !hash.empty() && file >= 0 && pwrite(file, hash.data(), DIGITS, static_cast<off_t>(seal)) == DIGITS;
  if (file >= 0)
  {
    close(file);
  }
  if (!written)
  {
    throw InputError(path + " cannot be written");
  }
}

bool isSealed(const std::string& path)
{
  const FileView view(path);
  const std::size_t seal = sealPlace(view.bytes());
  return seal < view.bytes().size() && view.bytes().substr(seal, DIGITS) == hashOf(view.bytes(), seal);
}
}  // namespace hjt
