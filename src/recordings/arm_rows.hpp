// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/run_file.hpp"
#include "output/output_file.hpp"

#include "arm/arm_recorder.hpp"

namespace hjt
{
/// The rows of an arm's motion in a file: CSV; `.bag`, what its driver would publish; `.h5`, as a run of a data set.
class ArmRows
{
public:
  /// `spec`: the run, ArmSpec::arm.state_rate that of the rows. `path`: empty, none. @throws InputError.
  ArmRows(const std::string& path, const RunSpec& spec, const MovingArm& moving);

  /// After every step of the motion; `row`: none, no row is due. @throws InputError.
  void take(Stamp stamp, double time, ArmRecorder& recorder, const ArmRow* row);

  void close();  ///< @throws InputError

private:
  std::string path_;
  RunSpec spec_;
  std::unique_ptr<RunFile> file_;
  std::optional<CsvWriter> csv_;
  std::vector<double> values_;
};
}  // namespace hjt
