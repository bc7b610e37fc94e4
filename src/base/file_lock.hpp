// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// Holds a file for this process alone, against others that ask in the same way; ends with the object, or with the
/// process however that ends. The content is left as it is.
class FileLock
{
public:
  /// Makes the file if it is not there; a link is not followed. @throws InputError if that fails, what is there is no
  /// regular file, or another holds it.
  explicit FileLock(const std::string& path)
    : descriptor_(open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666))
  {
    if (descriptor_ < 0)
    {
      throw InputError(path + " cannot be written: " + std::strerror(errno));
    }
    struct stat status
    {
    };
    std::string error;
    if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode))
    {
      error = " cannot be written: it is no regular file";
    }
    else if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
    {
      error = errno == EWOULDBLOCK ? " is being written by another program" :
                                     std::string(" cannot be locked: ") + std::strerror(errno);
    }
    if (!error.empty())
    {
      close(descriptor_);
      throw InputError(path + error);
    }
  }

  ~FileLock() { close(descriptor_); }

  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

private:
  int descriptor_;
};
}  // namespace hjt
