// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"

namespace hjt
{
/// Surfaces in memory for the twins of one process, one for each set of parameters. The pool is thread-safe, and a
/// caller waits only for the surface that it requests.
class SurfacePool
{
public:
  using Surface = std::shared_ptr<const ResponseSurface>;

  /// `kept`: number of the last requested surfaces that stay in memory even if no twin uses them, >= 1; 8 MB each.
  explicit SurfacePool(std::size_t kept) : kept_(kept) {}
  virtual ~SurfacePool() = default;
  SurfacePool(const SurfacePool&) = delete;
  SurfacePool& operator=(const SurfacePool&) = delete;

  /// Surface with this key, which may be null. `make` is called if the pool does not have this surface. If `make`
  /// throws, `obtain` throws the exception, and the next call of `obtain` calls its own `make`.
  virtual Surface obtain(const std::string& key, const std::function<Surface()>& make);

private:
  using Entry = std::pair<std::string, std::shared_future<Surface>>;

  std::list<Entry>::iterator find(const std::string& key);

  std::size_t kept_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // surfaces, the last requested surface first
};

struct SurfaceTables
{
  SurfaceTable table;
  DeviationTable deviations;
};

/// Surface of a gear from the cache or, if it is missing there, built and stored. Nothing if the gear has no surface.
///
/// `model`: joint of these parameters with its faults; `faults`: text of the faults for the cache, empty without
/// faults. If the teeth of a part differ by faults or errors of manufacture, the result contains the deviations of the
/// gear from the gear with equal teeth.
///
/// A file in the cache is valid if it is a regular file of this user, not writable for others, of at most 1 GB. It must
/// begin with the hash of this code and equal parameters and faults, end with the hash of its bytes, and contain finite
/// numbers on ascending lines. If a file is not valid, the table is built again and replaces the file. These checks
/// find damage and files of other builds, but not a table that the user has forged. Files are written atomically.
std::optional<SurfaceTables> obtainSurface(const Parameters& parameters, const JointModel& model,
                                           const std::string& faults, const SurfaceSource& source);

/// Surface of obtainSurface, shared in the pool of `source` if `source` has a pool.
SurfacePool::Surface sharedSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                   const SurfaceSource& source);

/// Surface of a gear with a BallTable for any fault of the bearing, shared in the pool of `source` if `source` has a
/// pool. Null if the teeth differ. `model`: joint with a sound bearing.
SurfacePool::Surface sharedBallSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                       const SurfaceSource& source);

/// Whether the directory has a file of the surface with this key. `key`: key of the surface in a SurfacePool.
bool surfaceIsKept(const std::string& key, const std::string& directory);

/// Path of the file in `directory` that holds the surface of the gear with equal teeth for these parameters.
std::string surfaceCacheFile(const Parameters& parameters, const std::string& directory);

/// Makes a directory for tables if it is missing. The directory must belong to the user and must not be writable for
/// everybody. @returns the reason why the directory cannot be used, as a sentence; empty if it can be used.
std::string makeCacheFolder(const std::string& directory);

/// Largest total size of the tables in a directory [bytes], from $HJT_CACHE_LIMIT [MB], or 4 GB. A single table may
/// exceed the limit. @throws ParameterError if HJT_CACHE_LIMIT is invalid.
std::uintmax_t cacheLimit();

/// Removes the least recently used tables (surface_*.bin, deviations_*.bin, balls_*.bin) until the remaining tables
/// have at most `most` bytes, but never the file `kept`. Also removes temporary files that are more than an hour old. A
/// twin can still use a removed table that it has read. @returns a sentence about the removed tables, or an empty text.
std::string tidyCache(const std::string& directory, const std::string& kept, std::uintmax_t most);
}  // namespace hjt
