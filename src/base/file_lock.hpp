// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// Holds a file for this process alone, against others that ask in the same way; ends with the object, or with the
/// process however that ends. The content is left as it is.
class FileLock
{
public:
  /// Makes the file if it is not there. @throws InputError if that fails, or another holds it.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

private:
  int descriptor_;
};
}  // namespace hjt
