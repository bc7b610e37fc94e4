// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <thread>

#include "datasets/sweep_directory.hpp"

#include "base/range.hpp"
#include "output/json.hpp"
#include "output/progress.hpp"
#include "twin/options.hpp"

namespace hjt
{
inline constexpr Range JOBS{ 1.0, 4096.0 };

/// Options of a sweep. Only plan and configuration change the content of a run's file.
struct SweepOptions : ConfigurationOptions
{
  std::string plan;                                                    ///< path of the plan
  std::string out;                                                     ///< directory of runs and index
  unsigned jobs{ std::max(1U, std::thread::hardware_concurrency()) };  ///< number of simultaneous runs, within JOBS
  std::uint64_t shard{};  ///< this process simulates the runs whose number modulo `shards` is `shard`
  std::uint64_t shards{ 1 };
  Watch watch;  ///< if it stops the sweep, finished runs are kept
};

void addOptions(OptionTable& table, SweepOptions& options);
void addJobsOption(OptionTable& table, unsigned& jobs);

struct SweepResult
{
  std::string index;                    ///< path of the file with a row for each run
  std::uint64_t runs{};                 ///< number of runs in the plan
  std::uint64_t done{};                 ///< number of runs that this call has finished
  std::uint64_t present{};              ///< number of runs that were finished before
  std::uint64_t damaged{};              ///< number of finished runs whose old file was damaged
  std::uint64_t failed{};               ///< number of failed runs of this shard, done or present
  std::uint64_t rows_without_forces{};  ///< sum over the runs of this shard
};

/// Simulates all runs of the shard that are not finished. @throws ParameterError, InputError if the plan is invalid,
/// before any run, or if a file cannot be written.
SweepResult sweep(const SweepOptions& options);

/// Sweeps a plan of lives. @throws InputError if it is another plan.
SweepResult sweepLives(const SweepOptions& options);

/// Sweeps a given plan into a given directory, which replace those of the options.
SweepResult runSweep(const Plan& plan, SweepDirectory& directory, const SweepOptions& options);

Json documentOf(const SweepResult& result);

/// Follows a number of such rows.
inline constexpr const char* WITHOUT_FORCES =
    "rows have no tooth forces (NaN), because the teeth had no equilibrium; index.csv names the runs";

/// Response surfaces for `jobs` simultaneous runs, each once in memory. The user's cache stores them, except those of
/// drives with individual wear, which are used once.
SurfaceSource runSurfaces(const Plan& plan, unsigned jobs);

/// @throws InputError if the plan is not one of lives.
void requireLives(const Plan& plan, const std::string& path);

/// Checks one run of the plan before any run starts, and returns it. @throws InputError as `Plan::run` does, with the
/// number of the run.
RunSpec checkedRun(const Plan& plan, std::uint64_t run);

/// Checks all runs, until the watch stops.
void checkRuns(const Plan& plan, const Watch& watch = {});
}  // namespace hjt
