// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "datasets/plan.hpp"
#include "output/ordered_json.hpp"

namespace hjt
{
/// Directory with the runs of a plan: plan.json, index.csv and the folder runs.
class SweepDirectory
{
public:
  SweepDirectory(const Plan& plan, std::string path) : plan_(plan), path_(std::move(path)) {}
  ~SweepDirectory();
  SweepDirectory(const SweepDirectory&) = delete;
  SweepDirectory& operator=(const SweepDirectory&) = delete;

  /// Makes the directory or opens an existing one. @throws InputError if it contains anything but runs of this plan.
  void open();

  /// Claims these runs for this process until the process ends, and removes incomplete files of killed processes.
  /// @throws InputError if another process has claimed one of the runs.
  void claim(const std::vector<std::uint64_t>& runs) const;

  /// Whether the file of the run exists, is complete and undamaged.
  bool isFinished(std::uint64_t run) const;

  std::string runFile(std::uint64_t run) const;      ///< path of the run's file
  std::string runFileName(std::uint64_t run) const;  ///< path of the run's file, relative to the directory
  OrderedJson record(std::uint64_t run) const;       ///< record of the run; empty if the run is not finished

  std::string index() const;  ///< path of index.csv
  void writeIndex() const;

  /// Header and rows of the index, without line ends. The row of a finished run comes from the run's record.
  std::string indexHeader() const;
  std::string indexRow(const OrderedJson& record) const;

private:
  std::uint64_t finishedRuns() const;

  const Plan& plan_;
  std::string path_;
  int plan_file_{ -1 };
};

/// First part of a run's row in the index: labels, variables and seeds.
OrderedJson recordOf(const RunSpec& spec, const std::string& file);
}  // namespace hjt
