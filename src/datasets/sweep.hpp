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

/// Options of a sweep. The content of a run's file depends only on plan and configuration.
struct SweepOptions : ConfigurationOptions
{
  std::string plan;  ///< path of the plan
  std::string out;   ///< directory for the files of the runs and the index
  unsigned jobs{ std::max(1U, std::thread::hardware_concurrency()) };  ///< number of runs at the same time, within JOBS
  std::uint64_t shard{};  ///< this process simulates the runs whose number modulo `shards` is `shard`
  std::uint64_t shards{ 1 };
  Watch watch;  ///< stops the sweep if it demands so; finished runs are kept
};

void addOptions(OptionTable& table, SweepOptions& options);
void addJobsOption(OptionTable& table, unsigned& jobs);

struct SweepResult
{
  std::string index;                    ///< path of index.csv, which has a row for each run
  std::uint64_t runs{};                 ///< number of runs in the plan
  std::uint64_t done{};                 ///< number of runs that this call has simulated
  std::uint64_t present{};              ///< number of runs that were already finished
  std::uint64_t damaged{};              ///< number of runs whose existing file was damaged
  std::uint64_t failed{};               ///< number of failed runs in this shard, from this call or earlier ones
  std::uint64_t rows_without_forces{};  ///< number of rows without tooth forces in the runs of this shard
};

/// Simulates all unfinished runs of the shard. @throws ParameterError, InputError if the plan is invalid, before any
/// run, or if a file cannot be written.
SweepResult sweep(const SweepOptions& options);

/// Simulates a plan of lives like `sweep`. @throws InputError if the plan is of another kind.
SweepResult sweepLives(const SweepOptions& options);

/// Simulates this plan into this directory. Plan and directory of the options are ignored.
SweepResult runSweep(const Plan& plan, SweepDirectory& directory, const SweepOptions& options);

Json documentOf(const SweepResult& result);

/// Rest of a notice that begins with the number of rows without tooth forces.
inline constexpr const char* WITHOUT_FORCES =
    "rows have no tooth forces (NaN), because the teeth had no equilibrium; index.csv counts them for each run";

/// Response surfaces for `jobs` simultaneous runs. Each surface is in memory once. The cache of the user stores the
/// surfaces, except those of drives with individual wear, which only one run uses.
SurfaceSource runSurfaces(const Plan& plan, unsigned jobs);

/// @throws InputError unless the plan is one of lives.
void requireLives(const Plan& plan, const std::string& path);

/// Specification of one run. @throws InputError as Plan::run, with the number of the run, before any run starts.
RunSpec checkedRun(const Plan& plan, std::uint64_t run);

/// Checks the specifications of all runs, until `watch` demands a stop.
void checkRuns(const Plan& plan, const Watch& watch = {});
}  // namespace hjt
