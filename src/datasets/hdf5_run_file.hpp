// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/hdf5_tools.hpp"
#include "datasets/run_file.hpp"

namespace hjt
{
/// A run as an HDF5 file: a group for each rate with a data set a column, time and severity, the indicators of each
/// window, the faults, the parameters, the record. docs/datasets.md describes it. The same run gives the same bytes: no
/// times are kept.
class Hdf5RunFile : public RunFile
{
public:
  Hdf5RunFile(const Recording& recording, const RunSpec& spec, const Twin* twin, std::string path);
  ~Hdf5RunFile() override;

  void record(Twin& twin, const DutyFeeder& feeder) override;
  void record(Stamp now, ArmRecorder& arm) override;
  void finish(OrderedJson record) override;

private:
  struct ColumnData
  {
    const RunColumn* column;  // none: time or severity
    bool is_table;
    Hdf5Handle dataset;
    std::size_t width;  // numbers a row
    std::vector<double> block;
  };
  struct Group
  {
    bool float32;
    Stamp period;  // [ns]
    hsize_t rows_in_block;
    hsize_t buffered{};
    hsize_t written{};
    bool per_tooth{};
    std::vector<ColumnData> columns{};
  };

  void writeParameters(const RunSpec& spec);
  void makeGroup(const RecordingGroup& recorded, const RunSpec& spec, double start, int deflate);
  bool isDue(const Group& group, Stamp now) const { return now > from_ && (now - from_) % group.period == 0; }
  double severityAt(double time, std::size_t joint) const;
  void finishRow(Group& group);
  void flush(Group& group);
  void writeIndicators();
  void close() noexcept;
  [[noreturn]] void fail() const;
  hid_t check(hid_t result) const;

  std::string path_;
  std::string temporary_;
  Hdf5Handle file_;
  Stamp from_{};  // later instants are recorded
  Stamp begin_{};
  std::vector<RunFault> faults_;
  std::size_t joints_;
  ToothForces teeth_;
  std::uint64_t rows_without_forces_{};
  std::vector<Group> groups_;
  bool indicators_;
  std::vector<SignalIndicators> windows_;
};
}  // namespace hjt
