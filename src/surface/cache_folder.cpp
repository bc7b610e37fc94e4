// SPDX-License-Identifier: BSD-3-Clause
#include "surface/cache_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "base/number_text.hpp"
#include "base/range.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

constexpr std::uintmax_t MEGABYTE = 1000000;

struct CachedFile
{
  fs::path path;
  fs::file_time_type used;
  std::uintmax_t size;
};

bool beginsLikeATable(const std::string& name)
{
  return name.rfind("surface_", 0) == 0 || name.rfind("deviations_", 0) == 0 || name.rfind("balls_", 0) == 0;
}

std::string megabytes(std::uintmax_t bytes)
{
  return std::to_string((bytes + MEGABYTE / 2) / MEGABYTE) + " MB";
}
}  // namespace

std::string makeCacheFolder(const std::string& directory)
{
  std::error_code error;
  fs::create_directories(fs::path(directory).parent_path(), error);
  mkdir(directory.c_str(), S_IRWXU);
  const int reason = errno;
  struct stat status = {};
  if (stat(directory.c_str(), &status) != 0)
  {
    return directory + " cannot be made: " + std::strerror(reason);
  }
  const bool is_own = status.st_uid == geteuid();
  if (!S_ISDIR(status.st_mode) || !is_own || (status.st_mode & S_IWOTH) != 0)
  {
    return directory + (!S_ISDIR(status.st_mode) ? " is no directory" :
                        !is_own                  ? " belongs to another user" :
                                                   " may be written to by everybody");
  }
  return "";
}

std::uintmax_t cacheLimit()
{
  constexpr double DEFAULT = 4000.0;
  constexpr Range RANGE{ 0.0, 1e9 };
  const char* given = std::getenv("HJT_CACHE_LIMIT");
  const std::optional<double> limit = given == nullptr ? DEFAULT : decimalNumber(given);
  if (!limit || !(*limit >= RANGE.min && *limit <= RANGE.max))
  {
    throw ParameterError("HJT_CACHE_LIMIT = " + std::string(given) + " [MB] is no number in the allowed range " +
                         rangeText(RANGE) + " [MB]");
  }
  return static_cast<std::uintmax_t>(*limit * MEGABYTE);
}

std::string tidyCache(const std::string& directory, const std::string& kept, std::uintmax_t most)
{
  constexpr std::chrono::hours ABANDONED{ 1 };
  std::vector<CachedFile> tables;
  std::uintmax_t total = 0;
  std::error_code error;
  // Others may remove files at the same time: what is gone is passed over.
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error))
  {
    std::error_code gone;
    const fs::path path = entry->path();
    const bool regular = fs::is_regular_file(fs::symlink_status(path, gone));
    const CachedFile file{ path, fs::last_write_time(path, gone), fs::file_size(path, gone) };
    if (gone || !regular || !beginsLikeATable(path.filename().string()))
    {
      continue;
    }
    if (path.extension() == ".bin")
    {
      total += file.size;
      tables.push_back(file);
    }
    else if (path.extension() == ".part" && fs::file_time_type::clock::now() - file.used > ABANDONED)
    {
      fs::remove(path, gone);
    }
  }
  std::sort(tables.begin(), tables.end(), [](const CachedFile& a, const CachedFile& b) { return a.used < b.used; });
  std::uintmax_t removed = 0;
  std::size_t count = 0;
  for (const CachedFile& table : tables)
  {
    std::error_code gone;
    if (total - removed > most && table.path != fs::path(kept) && fs::remove(table.path, gone))
    {
      removed += table.size;
      ++count;
    }
  }
  return count == 0 ? "" :
                      "removed " + std::to_string(count) + (count == 1 ? " table" : " tables") +
                          " of response surfaces, not used for longest, " + megabytes(removed) + ": " + directory +
                          " holds at most " + megabytes(most);
}
}  // namespace hjt
