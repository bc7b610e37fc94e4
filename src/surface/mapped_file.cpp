// SPDX-License-Identifier: BSD-3-Clause
#include "surface/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hjt
{
std::shared_ptr<const MappedFile> MappedFile::ofOwn(const std::string& path, std::size_t most)
{
  const int descriptor = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0)
  {
    return nullptr;
  }
  struct stat status = {};
  void* start = MAP_FAILED;
  std::size_t size = 0;
  if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
      (status.st_mode & (S_IWGRP | S_IWOTH)) == 0 && status.st_size > 0 &&
      static_cast<std::size_t>(status.st_size) <= most)
  {
    size = static_cast<std::size_t>(status.st_size);
    start = mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    futimens(descriptor, nullptr);  // without effect on a disk that is only read
  }
  close(descriptor);
  return start == MAP_FAILED ? nullptr : std::shared_ptr<const MappedFile>(new MappedFile(start, size));
}

MappedFile::~MappedFile()
{
  munmap(start_, size_);
}
}  // namespace hjt
