// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/run_file.hpp"
#include "output/output_file.hpp"

#include "arm/arm_recorder.hpp"

namespace hjt
{
/// Writes the rows of an arm's motion to a file. A CSV file has one row for each; a `.bag` has the messages that the
/// arm's driver would publish; an `.h5` file is like a run of a data set.
class ArmRows
{
public:
  /// `spec`: the run, ArmSpec::arm.state_rate that of the rows, which divides solver.rate. `path`: empty, none.
  /// `moving`: at the first row; stays there as long as this. @throws InputError.
  ArmRows(const std::string& path, const RunSpec& spec, const MovingArm& moving);

  /// After every step of the motion; `row`: none, no row is due. @throws InputError.
  void take(Stamp stamp, double time, ArmRecorder& recorder, const ArmRow* row);

  void close();  ///< @throws InputError

  /// Whether it is a run's file: without `close` nothing is left of it.
  bool isRun() const { return file_ != nullptr; }

private:
  const MovingArm& moving_;
  Stamp begin_;  // of the rows
  Stamp end_;    // of a run
  bool failed_{};
  std::uint64_t on_surface_{};
  std::string path_;
  RunSpec spec_;
  std::unique_ptr<RunFile> file_;
  std::optional<CsvWriter> csv_;
  std::vector<double> values_;
};
}  // namespace hjt
