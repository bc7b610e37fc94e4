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

  /// Makes it, or takes it up again. @throws InputError if it holds something else than runs of this very plan.
  void open();

  /// Keeps other processes from writing these runs until this one ends, and removes what one that was killed left of
  /// them. @throws InputError if another writes one of them.
  void claim(const std::vector<std::uint64_t>& runs) const;

  /// Whether the run's file is there, whole and undamaged.
  bool isFinished(std::uint64_t run) const;

  std::string runFile(std::uint64_t run) const;      ///< whole path
  std::string runFileName(std::uint64_t run) const;  ///< from the directory on
  OrderedJson record(std::uint64_t run) const;       ///< none if the run is not finished

  std::string index() const;  ///< path of index.csv
  /// Writes it from the runs' files.
  void writeIndex() const;

  /// One line of the index: of a finished run from its record, else with the status given. Without line end.
  std::string indexHeader() const;
  std::string indexRow(const OrderedJson& record) const;

private:
  std::uint64_t finishedRuns() const;

  const Plan& plan_;
  std::string path_;
  int plan_file_{ -1 };
};

/// Row of the index before the run: labels, variables, seeds.
OrderedJson recordOf(const RunSpec& spec, const std::string& file);
}  // namespace hjt
