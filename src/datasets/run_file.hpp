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
/// Key of a run's record: number of rows whose tooth forces are NaN, because the teeth had no equilibrium.
constexpr const char* ROWS_WITHOUT_FORCES = "rows_without_forces";

/// Key of an arm's record: joint, reason and time of a protective stop; empty without one.
constexpr const char* PROTECTIVE_STOP = "protective_stop";

/// Column, in the windows of a run's file, of a line's standard error, which also holds for the parts of the line.
std::string errorColumn(std::size_t indicator);

/// File of one run. `finish` gives it its final name.
class RunFile
{
public:
  virtual ~RunFile() = default;

  /// Must be called after every step of a drive. @throws InputError if it cannot be written.
  virtual void record(Twin& twin, const DutyFeeder& feeder) = 0;

  /// Must be called after every step of an arm at `now`, and before the first one. @throws InputError if it cannot be
  /// written.
  virtual void record(Stamp now, ArmRecorder& arm) = 0;

  /// Writes the rest, seals the file, flushes it to the disk and renames it. `record`: row of the index for this run,
  /// with an open seal. @throws InputError.
  virtual void finish(OrderedJson record) = 0;
};

/// `twin`: at the start of the recording; for an arm that of its first drive. Null for a run without a twin, whose file
/// has only the record. @throws InputError.
std::unique_ptr<RunFile> makeRunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                     const std::string& path);

/// Adds the outcome of a run's steps to its record. `on_surface`: number of steps on the response surface; `end`: time
/// of the last step [s].
void addOutcome(const TwinCounters& counters, std::uint64_t on_surface, double end, OrderedJson& record);

/// Adds an arm's protective stop to the record of its run.
void addProtectiveStop(const ArmDescription& arm, const MovingArm& moving, OrderedJson& record);

/// File name extension of the format, with the dot.
const char* runFileExtension(RunFormat format);

/// The record of a finished run; empty if there is no readable file.
OrderedJson readRunRecord(RunFormat format, const std::string& path);

/// Parameters of a run's HDF5 file as a text of describeParameters; empty if it has none.
std::string readRunParameters(const std::string& path);

/// Numbers by the name of their column, one for each row.
using Columns = std::map<std::string, std::vector<double>>;

/// Columns of the first group in a run's HDF5 file that has one of `holding`; empty if no group has.
/// @throws InputError if the file cannot be read.
Columns readRunColumns(const std::string& path, const std::vector<std::string>& holding);

/// Size of the numbers of a run [byte].
double dataSize(const Recording& recording, const RunSpec& spec);

/// See makeRunFile. The functions below throw InputError if hasHdf5() is false.
std::unique_ptr<RunFile> makeHdf5RunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                         const std::string& path);
/// Text of a data set; empty if it is missing.
std::string readHdf5Text(const std::string& path, const char* name);
/// See readRunColumns.
Columns readHdf5Columns(const std::string& path, const std::vector<std::string>& holding);
}  // namespace hjt
