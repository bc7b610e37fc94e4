// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <hdf5.h>

#include "apps/sweep/run_file.hpp"

namespace hjt
{
/// An object of the HDF5 library, closed at the end.
class Hdf5Handle
{
public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
  ~Hdf5Handle();

  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

private:
  hid_t id_{ -1 };
  Close close_{};
};

/// A run as an HDF5 file: a group for each rate with a data set a column, time and severity, the indicators of each
/// window, the faults, the parameters, the record. docs/datasets.md describes it. The same run gives the same bytes: no
/// times are kept.
class Hdf5RunFile : public RunFile
{
public:
  Hdf5RunFile(const Recording& recording, const RunSpec& spec, const Twin* twin, std::string path);
  ~Hdf5RunFile() override;

  void record(Twin& twin, const DutyFeeder& feeder) override;
  void finish(const OrderedJson& record) override;

  /// Of the data set of this name; empty if there is none.
  static std::string readText(const std::string& path, const char* name);
  static Columns readColumns(const std::string& path, const std::vector<std::string>& holding);

private:
  struct ColumnData
  {
    const RunColumn* column;  // none: time or severity
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

  void makeGroup(const RecordingGroup& recorded, const RunSpec& spec, const Twin& twin, double start, int deflate);
  double severityAt(double time) const;
  void flush(Group& group);
  void writeIndicators();
  void close() noexcept;
  [[noreturn]] void fail() const;
  hid_t check(hid_t result) const;

  std::string path_;
  std::string temporary_;
  Hdf5Handle file_;
  Stamp from_{};  // recorded are instants after this one
  Stamp begin_{};
  std::vector<GrowingFault> faults_;
  ToothForces teeth_;
  std::vector<Group> groups_;
  bool indicators_;
  std::vector<SignalIndicators> windows_;
};
}  // namespace hjt
