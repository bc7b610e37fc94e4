// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "apps/sweep/sweep_directory.hpp"

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
  bool quiet{};  ///< no progress
};

struct SweepResult
{
  std::uint64_t done{};     ///< runs finished by this call
  std::uint64_t present{};  ///< runs that stood there finished before
  std::uint64_t damaged{};  ///< of those done, runs whose file did not match the index
  std::uint64_t failed{};   ///< of this shard's, of those and of the others
};

/// Does all runs of the shard that are not finished. An interrupt ends it early; finished runs stay.
/// @throws InputError if a file cannot be written.
SweepResult runSweep(const Plan& plan, SweepDirectory& directory, const SweepOptions& options,
                     const SurfaceSource& surface_source);

/// What a run costs, tried on its first tenths of a second.
struct RunCost
{
  double surface{};           ///< before the first step, its response surface or the look for it in the cache [s]
  double start{};             ///< before the first step, the surface at hand [s]
  double real_time_factor{};  ///< simulated over real time, one core, nothing recorded [-]
};

/// @throws ParameterError if the run's drive has no equilibrium.
RunCost measureCost(const RunSpec& spec, const SurfaceSource& surface_source);

/// Checks every run of the plan. @throws InputError as `Plan::run`, with the number of the run.
void checkRuns(const Plan& plan);
}  // namespace hjt
