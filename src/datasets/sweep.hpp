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

/// How a plan is worked off. Only plan and configuration change what is in a run's file.
struct SweepOptions : ConfigurationOptions
{
  std::string plan;                                                    ///< file
  std::string out;                                                     ///< directory of runs and index
  unsigned jobs{ std::max(1U, std::thread::hardware_concurrency()) };  ///< runs at the same time, within JOBS
  std::uint64_t shard{};  ///< of `shards`: this process does the runs whose number leaves this remainder
  std::uint64_t shards{ 1 };
  Watch watch;  ///< finished runs stay where it stops
};

void addOptions(OptionTable& table, SweepOptions& options);
void addJobsOption(OptionTable& table, unsigned& jobs);

struct SweepResult
{
  std::string index;                    ///< file with a row for each run
  std::uint64_t runs{};                 ///< of the plan
  std::uint64_t done{};                 ///< runs finished by this call
  std::uint64_t present{};              ///< runs that stood there finished before
  std::uint64_t damaged{};              ///< runs of those done whose file was damaged
  std::uint64_t failed{};               ///< of this shard's, of those and of the others
  std::uint64_t rows_without_forces{};  ///< of them
};

/// Does all runs of the shard that are not finished. @throws InputError, ParameterError: of the plan, before any run,
/// or a file that cannot be written.
SweepResult sweep(const SweepOptions& options);

/// The same of a plan of lives. @throws InputError if it is none.
SweepResult sweepLives(const SweepOptions& options);

/// The same of a plan and a directory at hand, whatever the options name.
SweepResult runSweep(const Plan& plan, SweepDirectory& directory, const SweepOptions& options);

Json documentOf(const SweepResult& result);

/// Behind a number of rows of that kind.
inline constexpr const char* WITHOUT_FORCES =
    "rows without forces on the teeth (NaN): no equilibrium was found for them; index.csv says in which runs";

/// Response surfaces for so many runs at the same time, each once in memory. They are kept in the user's cache, but
/// those of drives with a wear of their own, which come but once.
SurfaceSource runSurfaces(const Plan& plan, unsigned jobs);

/// @throws InputError unless it is a plan of lives.
void requireLives(const Plan& plan, const std::string& path);

/// Checks one run of the plan before any run starts, and returns it. @throws InputError as `Plan::run`, with the number
/// of the run.
RunSpec checkedRun(const Plan& plan, std::uint64_t run);

/// All of them, until the watch stops.
void checkRuns(const Plan& plan, const Watch& watch = {});
}  // namespace hjt
