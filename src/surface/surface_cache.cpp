// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_cache.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <system_error>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.hpp"
#include "base/number_text.hpp"
#include "base/range.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/field_table.hpp"
#include "params/variants.hpp"
#include "surface/parallel_tasks.hpp"
#include "surface/surface_builder.hpp"
#include "surface/surface_ring.hpp"
#include "surface/table_file.hpp"

namespace hjt
{
SurfacePool::Surface SurfacePool::obtain(const std::string& key, const std::function<Surface()>& make)
{
  while (true)
  {
    std::promise<Surface> promise;
    std::shared_future<Surface> surface;
    bool mine = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const auto found = find(key);
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
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto found = find(key);
        if (found != entries_.end())
        {
          entries_.erase(found);
        }
        promise.set_exception(std::current_exception());
        throw;
      }
    }
    try
    {
      return surface.get();
    }
    catch (...)
    {
      // The exception of the other thread, perhaps from a request to stop, may not concern this thread.
    }
  }
}

std::list<SurfacePool::Entry>::iterator SurfacePool::find(const std::string& key)
{
  return std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.first == key; });
}

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
    return directory + (!S_ISDIR(status.st_mode) ? " is not a directory" :
                        !is_own                  ? " belongs to another user" :
                                                   " is writable for everybody");
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
    throw ParameterError("HJT_CACHE_LIMIT = " + std::string(given) + " [MB] is not a number in the allowed range " +
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
  // Other processes may remove files at the same time. Missing files are skipped.
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
                          " of response surfaces, the least recently used (" + megabytes(removed) + "), because " +
                          directory + " holds at most " + megabytes(most);
}

namespace
{
/// First words of a file; the hash of the code that made the file follows.
constexpr const char* FIRST_WORDS = "harmonic_joint_twin response surface ";
const std::string NO_SURFACE = "no response surface: ";
const std::string FULL_RING_INSTEAD = "; the twin solves the full ring at every step";

/// Header of a file, with all that determines the table: code, parameters with the files that they name, and faults.
std::string header(const Parameters& parameters, const std::string& faults)
{
  std::string text =
      FIRST_WORDS + std::string(surfaceSourceHash()) + '\n' + describeSurfaceParameters(parameters, !faults.empty());
  text += faults + '\n';
  for (const std::string& path :
       { parameters.manufacture.flexspline_pitch.table, parameters.manufacture.circular_spline_pitch.table })
  {
    if (path != NO_FILE)
    {
      text += wholeFile(path).value_or("");
    }
    text += '\n';
  }
  // Fills the header to a multiple of the size of a number, so that the numbers after the header are aligned.
  text.append((sizeof(double) - text.size() % sizeof(double)) % sizeof(double), '\n');
  return text;
}

std::string fileOf(const std::string& kind, const std::string& key, const std::string& directory)
{
  TextStream name;
  name << directory << '/' << kind << '_' << std::hex << textHash(key) << ".bin";
  return name.str();
}

void tell(const SurfaceSource& source, const std::string& what)
{
  if (source.notice)
  {
    source.notice(what);
  }
}

void tellMisses(const std::string& what, const GridChecks& checks, const SurfaceSource& source)
{
  constexpr double MUCH = 5.0;  // largest error over the tolerance that is not reported [-]
  if (checks.worst > MUCH)
  {
    tell(source, what + ": " + std::to_string(checks.missed) + " of " + std::to_string(checks.made) +
                     " checks between its nodes miss the tolerance. The largest error is " +
                     roundedText(checks.worst, 2) + " times the tolerance (docs/response_surface.md)");
  }
}

/// Reports a new table whose error is more than MUCH times its tolerance.
void tellMisses(const SurfaceTable& table, const SurfaceSource& source)
{
  tellMisses("response surface", table.checks, source);
  tellMisses("response surface, table of the forces of teeth", table.teeth.checks, source);
}

void tellMisses(const DeviationTable& table, const SurfaceSource& source)
{
  tellMisses("response surface, table for teeth that differ", table.checks, source);
}

void tellMisses(const BallTable& /*table*/, const SurfaceSource& /*source*/) {}

/// Table from the cache or, if it is missing there, built and stored. Empty if the build failed (reported to `source`).
template <class Table, class Build>
std::optional<Table> obtain(const std::string& kind, const std::string& key, const SurfaceSource& source, Build build)
{
  const std::string& directory = source.cache_directory;
  const std::uintmax_t limit = cacheLimit();
  const std::string unfit = directory.empty() ? "" : makeCacheFolder(directory);
  if (!unfit.empty())
  {
    tell(source, "response surface not stored: " + unfit);
  }
  const bool kept = !directory.empty() && unfit.empty();
  const std::string path = fileOf(kind, key, directory);
  Table table;
  if (kept && readTable(path, key, table))
  {
    return table;
  }
  auto built = build();
  if (!built.failure_reason.empty())
  {
    tell(source, NO_SURFACE + built.failure_reason + FULL_RING_INSTEAD);
    return std::nullopt;
  }
  tellMisses(built.table, source);
  if (kept)
  {
    const std::string problem = writeTable(path, key, built.table);
    if (!problem.empty())
    {
      tell(source, "response surface not stored: " + problem);
    }
    else
    {
      const std::string removed = tidyCache(directory, path, limit);
      if (!removed.empty())
      {
        tell(source, removed);
      }
      // The table is read from the file, because all processes share the memory of the file.
      Table shared;
      if (readTable(path, key, shared))
      {
        return shared;
      }
    }
  }
  return std::move(built.table);
}

/// Number of threads of a build. A build in the background leaves one processor to the twin.
unsigned threadsFor(const SurfaceSource& source)
{
  return std::max(1u, processors() - (source.background ? 1u : 0u));
}

/// Largest drop of a ball by any fault of the bearing at severity 1 [m].
double deepestDrop(const Parameters& parameters)
{
  RaceDeflection spalled(parameters.bearing);
  spalled.addOuterSpall(0.0, parameters.fault_scale.spall_depth, parameters.fault_scale.spall_length);
  return std::max(spalled.deepest(), parameters.fault_scale.cage_deflection);
}

/// Header of a BallTable's file, which contains the largest drop of a ball.
std::string ballHeader(const Parameters& parameters, const std::string& faults)
{
  return header(parameters, faults + "a ball that drops by " + numberText(deepestDrop(parameters)));
}

std::optional<BallTable> obtainBallTable(const Parameters& parameters, const JointModel& model,
                                         const std::string& faults, const SurfaceTable& surface,
                                         const SurfaceSource& source)
{
  return obtain<BallTable>("balls", ballHeader(parameters, faults), source,
                           [&]
                           {
                             return buildBallTable(parameters, model, deepestDrop(parameters), surface.lines.front(),
                                                   surface.lines.back(), source.progress, threadsFor(source));
                           });
}

/// SurfaceRing::repetition, or 1 without a solve of the ring if the teeth cannot differ.
int repetition(const Parameters& parameters, const JointModel& model, const std::string& faults)
{
  const bool alike = faults.empty() && teethAreAlike(parameters) && !model.ring.of<WaveGeneratorContact>().hasKinks();
  return alike ? 1 : SurfaceRing(parameters, model).repetition();
}

/// See obtainSurface. `teeth_alike`: whether to return nothing if the teeth differ.
std::optional<SurfaceTables> obtainTables(const Parameters& parameters, const JointModel& model,
                                          const std::string& faults, const SurfaceSource& source, bool teeth_alike)
{
  // A gear that does not repeat is detected before the cache is read, because keys do not say whether a gear repeats.
  const int pitches = repetition(parameters, model, faults);
  const Parameters equal_parameters = pitches == 1 ? parameters : withEqualTeeth(parameters);
  const JointModel equal = pitches == 1 ? model : JointModel(equal_parameters);
  if (pitches == 0 || (pitches > 1 && repetition(equal_parameters, equal, {}) != 1))
  {
    tell(source, NO_SURFACE + "the gear does not repeat after a turn of the motor" + FULL_RING_INSTEAD);
    return std::nullopt;
  }
  if (pitches > 1 && teeth_alike)
  {
    tell(source, NO_SURFACE + "the bearing is faulty and the teeth differ" + FULL_RING_INSTEAD);
    return std::nullopt;
  }
  const std::string key = pitches == 1 ? header(parameters, faults) : header(equal_parameters, {});
  const unsigned threads = threadsFor(source);
  std::optional<SurfaceTable> table = obtain<SurfaceTable>(
      "surface", key, source,
      [&] { return buildSurface(equal_parameters, equal, source.progress, MAX_SURFACE_POINTS, threads); });
  if (!table)
  {
    return std::nullopt;
  }
  SurfaceTables tables{ std::move(*table), {} };
  if (pitches > 1)
  {
    std::optional<DeviationTable> deviations = obtain<DeviationTable>(
        "deviations", header(parameters, faults), source,
        [&]
        {
          return buildDeviations(parameters, equal, model, pitches, tables.table.lines.front(),
                                 tables.table.lines.back(), source.progress, MAX_DEVIATION_POINTS, threads);
        });
    if (!deviations)
    {
      return std::nullopt;
    }
    tables.deviations = std::move(*deviations);
  }
  return tables;
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
  return fileOf("surface", header(parameters, {}), directory);
}

bool surfaceIsKept(const std::string& key, const std::string& directory)
{
  constexpr std::array KINDS{ "surface", "deviations", "balls" };
  return std::any_of(KINDS.begin(), KINDS.end(),
                     [&](const char* kind) { return std::filesystem::exists(fileOf(kind, key, directory)); });
}

std::optional<SurfaceTables> obtainSurface(const Parameters& parameters, const JointModel& model,
                                           const std::string& faults, const SurfaceSource& source)
{
  return obtainTables(parameters, model, faults, source, false);
}

SurfacePool::Surface sharedSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                   const SurfaceSource& source)
{
  const auto make = [&]() -> SurfacePool::Surface
  {
    std::optional<SurfaceTables> tables = obtainSurface(parameters, model, faults, source);
    return tables ? std::make_shared<const ResponseSurface>(std::move(tables->table), std::move(tables->deviations)) :
                    nullptr;
  };
  return source.pool ? source.pool->obtain(header(parameters, faults), make) : make();
}

SurfacePool::Surface sharedBallSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                       const SurfaceSource& source)
{
  const auto make = [&]() -> SurfacePool::Surface
  {
    std::optional<SurfaceTables> tables = obtainTables(parameters, model, faults, source, true);
    std::optional<BallTable> balls =
        tables ? obtainBallTable(parameters, model, faults, tables->table, source) : std::nullopt;
    return balls ?
               std::make_shared<const ResponseSurface>(std::move(tables->table), DeviationTable{},
                                                       BallDrops(std::make_shared<const BallTable>(std::move(*balls)),
                                                                 RaceDeflection(parameters.bearing))) :
               nullptr;
  };
  return source.pool ? source.pool->obtain(ballHeader(parameters, faults), make) : make();
}
}  // namespace hjt
