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
/// Surfaces in memory for the twins of one process, one for each set of parameters. It is thread-safe: a caller waits
/// only for the surface that it requests. If `make` throws, its caller gets the exception and the next caller tries
/// again.
class SurfacePool
{
public:
  using Surface = std::shared_ptr<const ResponseSurface>;

  /// `kept`: number of surfaces, at least one, that stay in memory without a twin that uses them: the last requested
  /// ones, 8 MB each.
  explicit SurfacePool(std::size_t kept) : kept_(kept) {}
  virtual ~SurfacePool() = default;
  SurfacePool(const SurfacePool&) = delete;
  SurfacePool& operator=(const SurfacePool&) = delete;

  /// The surface with this key, which `make` makes if it is missing; may be null.
  virtual Surface obtain(const std::string& key, const std::function<Surface()>& make);

private:
  using Entry = std::pair<std::string, std::shared_future<Surface>>;

  std::list<Entry>::iterator find(const std::string& key);

  std::size_t kept_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // last requested first
};

struct SurfaceTables
{
  SurfaceTable table;
  DeviationTable deviations;
};

/// Surface of a gear, from the cache or built and stored there. Nothing if the gear has none.
///
/// `model`: joint of these parameters with its faults; `faults`: text of the faults for the cache, empty without
/// faults. If the teeth of a part differ by faults or errors of manufacture, the table contains the gear's deviations
/// from one with equal teeth.
///
/// A file is valid if it is a regular file of this user, not writable for others, of at most 1 GB. It must begin with
/// the hash of this code and equal parameters and faults, end with the hash of its bytes, and contain finite numbers on
/// ascending lines. Otherwise the table is built again and replaces the file. These checks find damage and other
/// builds, but not a table that this user has forged. Files are written atomically.
std::optional<SurfaceTables> obtainSurface(const Parameters& parameters, const JointModel& model,
                                           const std::string& faults, const SurfaceSource& source);

/// Surface of a gear as of obtainSurface, from the source's pool if it has one.
SurfacePool::Surface sharedSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                   const SurfaceSource& source);

/// Surface of a gear with a table of the drops of its balls by any fault of the bearing, from the source's pool if it
/// has one. None if the teeth differ. `model`: with a sound bearing.
SurfacePool::Surface sharedBallSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                       const SurfaceSource& source);

/// Whether the directory has a file of the surface with this key of a pool.
bool surfaceIsKept(const std::string& key, const std::string& directory);

/// Path, in the directory, of the file of the surface with equal teeth for these parameters.
std::string surfaceCacheFile(const Parameters& parameters, const std::string& directory);

/// Makes a directory for tables if it is missing. It must belong to the user and must not be writable for everybody.
/// @returns the reason why it cannot be used, as a sentence; empty: it can.
std::string makeCacheFolder(const std::string& directory);

/// Largest size of all tables of a directory together, which a single table may exceed [bytes]: $HJT_CACHE_LIMIT, or 4
/// GB.
/// @throws ParameterError if HJT_CACHE_LIMIT is invalid.
std::uintmax_t cacheLimit();

/// Removes the least recently used tables (surface_*.bin, deviations_*.bin, balls_*.bin) until all together have at
/// most `most` bytes, but never `kept`. It also removes temporary files that are more than an hour old. Twins keep a
/// removed table that they use. @returns what it removed, as a sentence; empty: nothing.
std::string tidyCache(const std::string& directory, const std::string& kept, std::uintmax_t most);
}  // namespace hjt
