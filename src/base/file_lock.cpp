// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_lock.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
FileLock::FileLock(const std::string& path) : descriptor_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666))
{
  if (descriptor_ < 0)
  {
    throw InputError(path + " cannot be written: " + std::strerror(errno));
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
  {
    const int reason = errno;
    close(descriptor_);
    throw InputError(path + (reason == EWOULDBLOCK ? " is being written by another program" :
                                                     std::string(" cannot be locked: ") + std::strerror(reason)));
  }
}

FileLock::~FileLock()
{
  close(descriptor_);
}
}  // namespace hjt
