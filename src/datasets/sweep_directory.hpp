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
/// Directory of a plan's runs: plan.json, index.csv, runs/.
class SweepDirectory
{
public:
  SweepDirectory(const Plan& plan, std::string path) : plan_(plan), path_(std::move(path)) {}
  ~SweepDirectory();
  SweepDirectory(const SweepDirectory&) = delete;
  SweepDirectory& operator=(const SweepDirectory&) = delete;

  /// Makes the directory, or opens an existing one. @throws InputError if it contains other things than runs of this
  /// plan.
  void open();

  /// Claims these runs for this process until it ends, and removes incomplete files of killed processes. @throws
  /// InputError if another process has claimed one of them.
  void claim(const std::vector<std::uint64_t>& runs) const;

  /// Whether the run's file exists and is complete and undamaged.
  bool isFinished(std::uint64_t run) const;

  std::string runFile(std::uint64_t run) const;      ///< path of the file
  std::string runFileName(std::uint64_t run) const;  ///< path of the file relative to the directory
  OrderedJson record(std::uint64_t run) const;       ///< empty if the run is not finished

  std::string index() const;  ///< path of index.csv
  void writeIndex() const;

  /// Line of the index: of a finished run from its record, else with the given status. There is no line end.
  std::string indexHeader() const;
  std::string indexRow(const OrderedJson& record) const;

private:
  std::uint64_t finishedRuns() const;

  const Plan& plan_;
  std::string path_;
  int plan_file_{ -1 };
};

/// Beginning of a run's row in the index: labels, variables, seeds.
OrderedJson recordOf(const RunSpec& spec, const std::string& file);
}  // namespace hjt
