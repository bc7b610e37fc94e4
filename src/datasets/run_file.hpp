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
/// Of a run's record: rows whose forces on the teeth are NaN, as no equilibrium of the teeth was found for them.
constexpr const char* ROWS_WITHOUT_FORCES = "rows_without_forces";

/// Of an arm's record: joint, reason and time of its protective stop, or empty.
constexpr const char* PROTECTIVE_STOP = "protective_stop";

/// Of the windows in a run's file, the standard error of a line; its parts have that of its amplitude.
std::string errorColumn(std::size_t indicator);

/// File of one run. It gets its name in `finish`.
class RunFile
{
public:
  virtual ~RunFile() = default;

  /// After every step of a drive. @throws InputError if the disk does not take it.
  virtual void record(Twin& twin, const DutyFeeder& feeder) = 0;

  /// After every step of an arm, at `now`; before the first of its motion too. @throws InputError alike.
  virtual void record(Stamp now, ArmRecorder& arm) = 0;

  /// Writes what is known only now, seals the file, brings it to the disk and gives it its name. `record`: the run's
  /// row of the index, with an open seal. @throws InputError.
  virtual void finish(OrderedJson record) = 0;
};

/// `twin`: at the start of what is recorded, of an arm its first drive; none if the run has none, then only the record
/// is written. @throws InputError.
std::unique_ptr<RunFile> makeRunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                     const std::string& path);

/// How the steps of a run went, into its record. `on_surface`: steps on the response surface; `end`: time of the last
/// step [s].
void addOutcome(const TwinCounters& counters, std::uint64_t on_surface, double end, OrderedJson& record);

/// An arm's protective stop, into the record of its run.
void addProtectiveStop(const ArmDescription& arm, const MovingArm& moving, OrderedJson& record);

/// Extension of the format's files, with the dot.
const char* runFileExtension(RunFormat format);

/// The record of a finished run; none if there is no readable file.
OrderedJson readRunRecord(RunFormat format, const std::string& path);

/// The parameters of a run's HDF5 file, as describeParameters has them; empty if it holds none.
std::string readRunParameters(const std::string& path);

/// Numbers by the name of their column, one a row each.
using Columns = std::map<std::string, std::vector<double>>;

/// The columns of the first group of a run's HDF5 file that holds one of these; none if no group does.
/// @throws InputError if the file cannot be read.
Columns readRunColumns(const std::string& path, const std::vector<std::string>& holding);

/// Bytes of the numbers of a run.
double dataSize(const Recording& recording, const RunSpec& spec);

/// See makeRunFile. These throw InputError where hasHdf5() is false.
std::unique_ptr<RunFile> makeHdf5RunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                         const std::string& path);
/// The data set of this name; empty if there is none.
std::string readHdf5Text(const std::string& path, const char* name);
/// See readRunColumns.
Columns readHdf5Columns(const std::string& path, const std::vector<std::string>& holding);
}  // namespace hjt
