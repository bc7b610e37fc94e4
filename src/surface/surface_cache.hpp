// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"
#include "surface/surface_pool.hpp"

namespace hjt
{
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
}  // namespace hjt
