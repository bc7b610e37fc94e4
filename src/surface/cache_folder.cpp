// SPDX-License-Identifier: BSD-3-Clause
#include "surface/cache_folder.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <vector>

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

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
  constexpr std::uintmax_t MEGABYTE = 1000000;
  return std::to_string((bytes + MEGABYTE / 2) / MEGABYTE) + " MB";
}
}  // namespace

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
