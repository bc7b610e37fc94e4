// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/sweep/plan.hpp"

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
  std::uint64_t failed{};   ///< of this shard's, of those and of the others
};

/// Directory of a plan's runs: plan.json, index.csv, runs/.
class SweepDirectory
{
public:
  SweepDirectory(const Plan& plan, std::string path) : plan_(plan), path_(std::move(path)) {}

  /// Makes it, or takes it up again. @throws InputError if it holds something else than runs of this very plan.
  void open() const;

  std::string runFile(std::uint64_t run) const;            ///< whole path
  std::string runFileName(std::uint64_t run) const;        ///< from the directory on
  nlohmann::ordered_json record(std::uint64_t run) const;  ///< none if the run is not finished

  /// Writes index.csv from the runs' files.
  void writeIndex() const;

  /// One line of the index: of a finished run from its record, else with the status given. Without line end.
  std::string indexHeader() const;
  std::string indexRow(const nlohmann::ordered_json& record) const;

private:
  std::uint64_t finishedRuns() const;

  const Plan& plan_;
  std::string path_;
};

/// What the index says of a run before it has run: labels, variables, seeds.
nlohmann::ordered_json recordOf(const RunSpec& spec, const std::string& file);

/// Does all runs of the shard that are not finished. An interrupt ends it early; finished runs stay.
/// @throws InputError if a file cannot be written.
SweepResult runSweep(const Plan& plan, const SweepDirectory& directory, const SweepOptions& options,
                     const SurfaceSource& surface_source);

/// What a run costs, tried on its first tenths of a second.
struct RunCost
{
  double start{};             ///< before the first step [s]
  double real_time_factor{};  ///< simulated over real time, one core, nothing recorded [-]
};

/// @throws ParameterError if the run's drive has no equilibrium.
RunCost measureCost(const RunSpec& spec, const SurfaceSource& surface_source);

/// Checks every run of the plan. @throws InputError as `Plan::run`, with the number of the run.
void checkRuns(const Plan& plan);
}  // namespace hjt
