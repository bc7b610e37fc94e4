// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// A temporary directory, which the destructor removes with its content.
class TemporaryDirectory
{
public:
  /// @throws InputError if the directory cannot be made.
  TemporaryDirectory()
  {
    std::string name = (std::filesystem::temp_directory_path() / "joint_twin_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
    {
      throw InputError("cannot make a directory in " + std::filesystem::temp_directory_path().string() + ": " +
                       std::strerror(errno));
    }
    path_ = name;
  }
  ~TemporaryDirectory()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  std::string path() const { return path_.string(); }

private:
  std::filesystem::path path_;
};
}  // namespace hjt
