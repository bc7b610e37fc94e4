// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace hjt
{
/// A file in memory, read-only and shared: all processes that map it have one copy. It stays as long as the object,
/// also where the file's name is removed or given to another file.
class MappedFile
{
public:
  /// Only a regular file of this user that others cannot write, neither empty nor larger than `most` bytes; else null.
  /// Opening it does not wait, as it would for the writer of a FIFO. The file counts as used now.
  static std::shared_ptr<const MappedFile> ofOwn(const std::string& path, std::size_t most);

  ~MappedFile();

  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// Begins at a multiple of a page.
  std::string_view bytes() const noexcept { return { static_cast<const char*>(start_), size_ }; }

private:
  MappedFile(void* start, std::size_t size) noexcept : start_(start), size_(size) {}

  void* start_;
  std::size_t size_;
};
}  // namespace hjt
