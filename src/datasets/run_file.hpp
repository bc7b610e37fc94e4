// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "datasets/plan.hpp"
#include "datasets/run_duty.hpp"
#include "output/ordered_json.hpp"

namespace hjt
{
/// Key in the record of a run: number of rows whose tooth forces are NaN, because the teeth had no equilibrium.
constexpr const char* ROWS_WITHOUT_FORCES = "rows_without_forces";

/// Key in the record of an arm's run: joint, reason and time of a protective stop; empty if there was none.
constexpr const char* PROTECTIVE_STOP = "protective_stop";

/// Column with the standard error of a line's amplitude and of its cosine and sine, in the windows of a run's file.
std::string errorColumn(std::size_t indicator);

/// Writes the file of one run. The file gets its final name in `finish`.
class RunFile
{
public:
  virtual ~RunFile() = default;

  /// The caller calls this function after every step of a drive. @throws InputError if the file cannot be written.
  virtual void record(Twin& twin, const DutyFeeder& feeder) = 0;

  /// The caller calls this function before the first step of an arm, and after every step, which ends at `now`.
  /// @throws InputError if the file cannot be written.
  virtual void record(Stamp now, ArmRecorder& arm) = 0;

  /// Writes the remaining data, seals the file, flushes it to the disk and renames it. `record`: row of the index for
  /// this run; its seal has no digits yet. @throws InputError.
  virtual void finish(OrderedJson record) = 0;
};

/// Makes the file of a run. `twin`: the twin at the start of the recording, for an arm its first drive. It is null for
/// a run without a twin, whose file contains only the record. @throws InputError.
std::unique_ptr<RunFile> makeRunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                     const std::string& path);

/// Adds the outcome of a run to its record. `on_surface`: number of steps on the response surface; `end`: time of the
/// last step since the start of the run [s].
void addOutcome(const TwinCounters& counters, std::uint64_t on_surface, double end, OrderedJson& record);

/// Adds an arm's protective stop to the record of its run.
void addProtectiveStop(const ArmDescription& arm, const MovingArm& moving, OrderedJson& record);

/// Extension of the file's name for a format, including the dot.
const char* runFileExtension(RunFormat format);

/// Reads the record of a finished run; empty if there is no readable file.
OrderedJson readRunRecord(RunFormat format, const std::string& path);

/// Reads the parameters of a run's HDF5 file, as text in the format of describeParameters; empty if there are none.
std::string readRunParameters(const std::string& path);

/// Numbers of each column, one for each row, by the name of the column.
using Columns = std::map<std::string, std::vector<double>>;

/// Reads the columns of the first group in a run's HDF5 file that contains a column of `holding`; empty if there is no
/// such group. @throws InputError if the file cannot be read.
Columns readRunColumns(const std::string& path, const std::vector<std::string>& holding);

/// Size of the recorded numbers of a run without compression [byte].
double dataSize(const Recording& recording, const RunSpec& spec);

/// HDF5 version of makeRunFile. This and the following functions throw InputError if hasHdf5() is false.
std::unique_ptr<RunFile> makeHdf5RunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                         const std::string& path);
/// Text of a data set in an HDF5 file; empty if the data set is missing.
std::string readHdf5Text(const std::string& path, const char* name);
/// HDF5 version of readRunColumns.
Columns readHdf5Columns(const std::string& path, const std::vector<std::string>& holding);
}  // namespace hjt
