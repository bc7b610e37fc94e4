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
/// Surfaces in memory for the twins of one process, one for each set of parameters. Safe to use from several threads:
/// who asks for one that is being made waits for it, and who asks for another does not. Where `make` throws, its caller
/// gets the exception and the next asker tries again.
class SurfacePool
{
public:
  using Surface = std::shared_ptr<const ResponseSurface>;

  /// `kept`: number of surfaces, at least one, that stay in memory, the last requested ones, 8 MB each, also while no
  /// twin uses them.
  explicit SurfacePool(std::size_t kept) : kept_(kept) {}
  virtual ~SurfacePool() = default;
  SurfacePool(const SurfacePool&) = delete;
  SurfacePool& operator=(const SurfacePool&) = delete;

  /// The surface under this key, made by `make` if it is not there; may be none.
  virtual Surface obtain(const std::string& key, const std::function<Surface()>& make);

private:
  using Entry = std::pair<std::string, std::shared_future<Surface>>;

  std::list<Entry>::iterator find(const std::string& key);

  std::size_t kept_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // last requested first
};

/// A surface's tables.
struct SurfaceTables
{
  SurfaceTable table;
  DeviationTable deviations;
};

/// The surface of a gear: from the cache, or built and put there. Nothing if the gear has none.
///
/// `model`: the joint of these parameters with its faults; `faults`: names what they changed in it, for the cache;
/// empty: none. Teeth of one member may differ, by faults or by errors of manufacture: then the gear is tabulated as
/// deviation from one of equal teeth.
///
/// A file counts only if it is a regular file of this user that others cannot write, not larger than 1 GB, begins with
/// the hash of this very code, the same parameters and faults, ends with the hash of all its bytes, and holds finite
/// numbers on ascending lines; else the table is built again and the file replaced. That finds damage and other builds,
/// not a table that this user has forged. Files appear whole or not at all.
std::optional<SurfaceTables> obtainSurface(const Parameters& parameters, const JointModel& model,
                                           const std::string& faults, const SurfaceSource& source);

/// The same, from the source's pool if it has one.
SurfacePool::Surface sharedSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                   const SurfaceSource& source);

/// The surface of a gear whose balls can drop as far as any fault of the bearing lets them, the bearing still sound;
/// from the source's pool if it has one. None where teeth differ. `model`: with a sound bearing.
SurfacePool::Surface sharedBallSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                       const SurfaceSource& source);

/// Whether the directory has a file of the surface that a pool is asked for by this key.
bool surfaceIsKept(const std::string& key, const std::string& directory);

/// File of the surface of these parameters, all teeth equal, within the directory.
std::string surfaceCacheFile(const Parameters& parameters, const std::string& directory);

/// Makes a folder for tables, unless it is there. @returns why it is not used, as a sentence; empty: it is. It must be
/// the user's own, and not everybody may write to it.
std::string makeCacheFolder(const std::string& directory);

/// All tables of a folder together have no more, unless one alone has [bytes]: $HJT_CACHE_LIMIT, or 4 GB.
/// @throws ParameterError.
std::uintmax_t cacheLimit();

/// Removes the tables (surface_*.bin, deviations_*.bin, balls_*.bin) that have not been used for longest until all
/// together have no more than `most` bytes, but never `kept`; and temporary files that a writer left more than an hour
/// ago. Twins that use a removed table keep it. @returns what it removed, as a sentence; empty: nothing.
std::string tidyCache(const std::string& directory, const std::string& kept, std::uintmax_t most);
}  // namespace hjt
