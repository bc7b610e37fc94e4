// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/surface_cache.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/params/text_hash.hpp"
#include "harmonic_joint_twin/twin/surface_builder.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

/// First line of a file. To be changed whenever the table, or what the ring does with its parameters, changes.
constexpr const char* FORMAT = "harmonic_joint_twin response surface 1\n";
/// Sections that the ring in equilibrium does not depend on.
constexpr std::array<const char*, 8> OTHER_SECTIONS{ "joint.",  "brake.", "solver.",  "sensors.",
                                                     "health.", "input.", "publish.", "realtime." };

/// Format and every parameter that the surface may depend on.
std::string header(const Parameters& parameters)
{
  std::istringstream lines(describeParameters(parameters));
  std::string text = FORMAT;
  for (std::string line; std::getline(lines, line);)
  {
    const bool other = std::any_of(OTHER_SECTIONS.begin(), OTHER_SECTIONS.end(),
                                   [&](const char* section) { return line.rfind(section, 0) == 0; });
    text += other ? "" : line.substr(0, line.find("  #")) + '\n';
  }
  return text + '\n';
}

template <class T>
void append(std::string& bytes, const T* values, std::size_t count)
{
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// The table's numbers as they lie in memory: the cache is for this machine.
std::string body(const SurfaceTable& table)
{
  std::string bytes;
  const std::array<double, 4> sizes{ table.pitch, table.ratio, static_cast<double>(table.columns),
                                     static_cast<double>(table.lines.size()) };
  append(bytes, sizes.data(), sizes.size());
  append(bytes, table.lines.data(), table.lines.size());
  append(bytes, table.nodes.data(), table.nodes.size());
  return bytes;
}

std::optional<SurfaceTable> parseBody(std::string_view bytes)
{
  constexpr double MOST = 1e6;  // lines or columns
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
  if (numbers.size() < 4 || !std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }) ||
      !(numbers[2] >= 1.0 && numbers[2] < MOST && numbers[3] >= 2.0 && numbers[3] < MOST))
  {
    return std::nullopt;
  }
  SurfaceTable table;
  table.pitch = numbers[0];
  table.ratio = numbers[1];
  table.columns = static_cast<int>(numbers[2]);
  const auto lines = static_cast<std::size_t>(numbers[3]);
  const std::size_t nodes = lines * (static_cast<std::size_t>(table.columns) + 1);
  if (bytes.size() != sizeof(double) * (4 + lines + nodes * SurfaceTable::VALUES))
  {
    return std::nullopt;
  }
  table.lines.assign(numbers.begin() + 4, numbers.begin() + 4 + static_cast<std::ptrdiff_t>(lines));
  table.nodes.resize(nodes);
  std::memcpy(table.nodes.data(), bytes.data() + sizeof(double) * (4 + lines), nodes * sizeof(SurfaceTable::Node));
  if (!std::is_sorted(table.lines.begin(), table.lines.end(), std::less_equal<>()))
  {
    return std::nullopt;
  }
  return table;
}

std::optional<SurfaceTable> readFile(const std::string& path, const std::string& wanted)
{
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::uint64_t sum = 0;
  if (!file || bytes.size() < wanted.size() + sizeof(sum) || bytes.compare(0, wanted.size(), wanted) != 0)
  {
    return std::nullopt;
  }
  const std::string_view rest = std::string_view(bytes).substr(wanted.size());
  const std::string_view values = rest.substr(0, rest.size() - sizeof(sum));
  std::memcpy(&sum, rest.data() + values.size(), sizeof(sum));
  return sum == textHash(values) ? parseBody(values) : std::nullopt;
}

/// @returns what went wrong, or nothing.
std::string writeFile(const std::string& path, const std::string& bytes)
{
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  const std::string temporary = path + '.' + std::to_string(std::random_device{}());
  {
    std::ofstream file(temporary, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file)
    {
      fs::remove(temporary, error);
      return "cannot write " + temporary;
    }
  }
  fs::rename(temporary, path, error);
  if (error)
  {
    const std::string reason = error.message();
    fs::remove(temporary, error);
    return "cannot write " + path + ": " + reason;
  }
  return {};
}
}  // namespace

std::string surfaceCacheDirectory()
{
  const auto variable = [](const char* name)
  {
    const char* value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  const std::string cache = variable("XDG_CACHE_HOME");
  const std::string home = variable("HOME");
  const std::string base = !cache.empty() ? cache : !home.empty() ? home + "/.cache" : "";
  return base.empty() ? "" : base + "/harmonic_joint_twin";
}

std::string surfaceCacheFile(const Parameters& parameters, const std::string& directory)
{
  std::ostringstream name;
  name << directory << "/surface_" << std::hex << textHash(header(parameters)) << ".bin";
  return name.str();
}

std::optional<SurfaceTable> obtainSurface(const Parameters& parameters, const SurfaceSource& source)
{
  const auto tell = [&](const std::string& what)
  {
    if (source.notice)
    {
      source.notice(what);
    }
  };
  // Before the cache is asked: its key has the parameters only, not the files that they name.
  const std::string obstacle = surfaceObstacle(parameters);
  if (!obstacle.empty())
  {
    tell("no response surface: " + obstacle + "; the twin solves the full ring at every step");
    return std::nullopt;
  }
  const bool kept = !source.cache_directory.empty();
  const std::string key = header(parameters);
  const std::string path = kept ? surfaceCacheFile(parameters, source.cache_directory) : "";
  if (kept)
  {
    if (std::optional<SurfaceTable> table = readFile(path, key))
    {
      return table;
    }
  }
  SurfaceBuild build = buildSurface(parameters, source.progress);
  if (!build.obstacle.empty())
  {
    tell("no response surface: " + build.obstacle + "; the twin solves the full ring at every step");
    return std::nullopt;
  }
  if (kept)
  {
    std::string bytes = body(build.table);
    const std::uint64_t sum = textHash(bytes);
    append(bytes, &sum, 1);
    const std::string problem = writeFile(path, key + bytes);
    if (!problem.empty())
    {
      tell("response surface not kept: " + problem);
    }
  }
  return std::move(build.table);
}

SurfacePool::Surface SurfacePool::obtain(const std::string& key, const std::function<Surface()>& make)
{
  std::promise<Surface> promise;
  std::shared_future<Surface> surface;
  bool mine = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.first == key; });
    mine = found == entries_.end();
    if (mine)
    {
      entries_.emplace_front(key, promise.get_future().share());
      if (entries_.size() > kept_)
      {
        entries_.pop_back();
      }
    }
    else
    {
      entries_.splice(entries_.begin(), entries_, found);
    }
    surface = entries_.front().second;
  }
  if (mine)
  {
    try
    {
      promise.set_value(make());
    }
    catch (...)
    {
      promise.set_exception(std::current_exception());
    }
  }
  return surface.get();
}

SurfacePool::Surface sharedSurface(const Parameters& parameters, const SurfaceSource& source)
{
  const auto make = [&]() -> SurfacePool::Surface
  {
    std::optional<SurfaceTable> table = obtainSurface(parameters, source);
    return table ? std::make_shared<const ResponseSurface>(std::move(*table)) : nullptr;
  };
  return source.pool ? source.pool->obtain(header(parameters), make) : make();
}
}  // namespace hjt
