// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "datasets/sweep_directory.hpp"

#include "surface/surface_cache.hpp"

namespace hjt
{
/// How a plan is worked off. Nothing here changes a byte of a run's file.
struct SweepOptions
{
  std::string directory;
  unsigned jobs{ 1 };
  std::uint64_t shard{};  ///< of `shards`: this process does the runs whose number leaves this remainder
  std::uint64_t shards{ 1 };
};

struct SweepResult
{
  std::uint64_t done{};                 ///< runs finished by this call
  std::uint64_t present{};              ///< runs that stood there finished before
  std::uint64_t damaged{};              ///< runs of those done whose file was damaged
  std::uint64_t failed{};               ///< of this shard's, of those and of the others
  std::uint64_t rows_without_forces{};  ///< of them
};

/// Does all runs of the shard that are not finished. An interrupt ends it early; finished runs stay.
/// @throws InputError if a file cannot be written.
SweepResult runSweep(const Plan& plan, SweepDirectory& directory, const SweepOptions& options,
                     const SurfaceSource& surface_source);

/// A run of the plan before any has started. @throws InputError as `Plan::run`, with the number of the run.
RunSpec checkedRun(const Plan& plan, std::uint64_t run);

/// All of them.
void checkRuns(const Plan& plan);
}  // namespace hjt
