// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/run_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "base/publish_period.hpp"
#include "base/whole_file.hpp"
#include "datasets/file_seal.hpp"
#include "datasets/lives.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "health/indicator_table.hpp"

namespace hjt
{
namespace
{
/// Handle of an HDF5 object, which the destructor closes.
class Hdf5Handle
{
public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }

  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept
  {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }

  ~Hdf5Handle()
  {
    if (id_ >= 0)
    {
      close_(id_);
    }
  }

  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

private:
  hid_t id_{ -1 };
  Close close_{};
};

/// Locks the HDF5 library, which is not thread-safe. Every use of the library needs this lock, also closing a handle.
std::unique_lock<std::mutex> lockLibrary()
{
  static std::mutex mutex;
  std::unique_lock<std::mutex> lock(mutex);
  // Without this call, the library at the end of the process would close files that a full disk left open, and crash.
  [[maybe_unused]] static const herr_t ENDS_BY_ITSELF = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // exceptions report the errors
  return lock;
}

/// Properties for the creation of an object without time stamps.
Hdf5Handle withoutTimes(hid_t kind)
{
  Hdf5Handle properties(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(properties.get(), false);
  return properties;
}

Hdf5Handle textType(std::size_t length)
{
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(length, 1));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  return type;
}

/// Writes an attribute of variable length. Readers return such an attribute as text, but one of fixed length as bytes.
void writeText(hid_t object, const char* name, const std::string& text)
{
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* const content = text.c_str();
  H5Awrite(attribute.get(), type.get(), &content);
}

void writeNumber(hid_t object, const char* name, double value)
{
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(object, name, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &value);
}

/// Writes a text as a data set, because an attribute has at most 64 kB.
bool writeTextDataset(hid_t file, const char* name, const std::string& text)
{
  const Hdf5Handle type = textType(text.size());
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle properties = withoutTimes(H5P_DATASET_CREATE);
  const Hdf5Handle dataset(H5Dcreate2(file, name, type.get(), space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                           H5Dclose);
  return H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0;
}

/// Writes numbers as a data set. @returns the status of the HDF5 library, negative after an error.
herr_t writeRows(hid_t group, const char* name, const char* unit, const std::vector<double>& rows)
{
  const hsize_t count = rows.size();
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle properties = withoutTimes(H5P_DATASET_CREATE);
  const Hdf5Handle dataset(
      H5Dcreate2(group, name, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid())
  {
    return -1;
  }
  writeText(dataset.get(), "unit", unit);
  return rows.empty() ? 0 : H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
}

constexpr hsize_t ROWS_IN_CHUNK = 4096;
constexpr const char* TIME = "time";
constexpr const char* SEVERITY = "severity";

/// Memory layout of a fault. The layout in the file is the same, but without padding.
struct FaultRow
{
  char joint[32];
  char kind[32];
  double severity;
  std::int32_t place;
  double onset;
  double ramp;
};

/// Writes the faults as a table. `arm` is empty for a single drive; then the table has no column of joints.
bool writeFaults(hid_t file, const std::vector<RunFault>& faults, const std::optional<ArmSpec>& arm)
{
  std::vector<FaultRow> rows(faults.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const Fault& fault = faults[i].fault;
    rows[i] = { {}, {}, fault.severity, fault.place, fault.onset, faults[i].ramp };
    if (arm)
    {
      arm->arm.joints[faults[i].joint].short_name.copy(rows[i].joint, sizeof(rows[i].joint));
    }
    std::string(describe(fault.kind).name).copy(rows[i].kind, sizeof(rows[i].kind));
  }
  const Hdf5Handle name = textType(sizeof(FaultRow::kind));
  const Hdf5Handle memory(H5Tcreate(H5T_COMPOUND, sizeof(FaultRow)), H5Tclose);
  if (arm)
  {
    H5Tinsert(memory.get(), "joint", offsetof(FaultRow, joint), name.get());
  }
  H5Tinsert(memory.get(), "kind", offsetof(FaultRow, kind), name.get());
  H5Tinsert(memory.get(), "severity", offsetof(FaultRow, severity), H5T_NATIVE_DOUBLE);
  H5Tinsert(memory.get(), "place", offsetof(FaultRow, place), H5T_NATIVE_INT32);
  H5Tinsert(memory.get(), "onset", offsetof(FaultRow, onset), H5T_NATIVE_DOUBLE);
  H5Tinsert(memory.get(), "ramp", offsetof(FaultRow, ramp), H5T_NATIVE_DOUBLE);
  const Hdf5Handle packed(H5Tcopy(memory.get()), H5Tclose);
  H5Tpack(packed.get());
  const hsize_t count = rows.size();
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle properties = withoutTimes(H5P_DATASET_CREATE);
  const Hdf5Handle dataset(
      H5Dcreate2(file, "faults", packed.get(), space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Dclose);
  writeText(dataset.get(), "unit", "severity [-], 0 ... 1; place: tooth, segment or ball, -1 = all; onset, ramp [s]");
  return dataset.valid() &&
         (rows.empty() || H5Dwrite(dataset.get(), memory.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0);
}

/// A run as an HDF5 file, in the format of docs/datasets.md. The file has a group for each rate, with a data set for
/// each column, for time and for severity. It also has the indicators of each window, faults, parameters and record.
/// Equal runs give equal bytes, because the file has no time stamps.
class Hdf5RunFile : public RunFile
{
public:
  Hdf5RunFile(const Recording& recording, const RunSpec& spec, const Twin* twin, std::string path)
    : path_(std::move(path))
    , temporary_(makeFileBeside(path_))
    , faults_(spec.faults)
    , joints_(spec.arm ? spec.arm->drives.size() : 1)
    , indicators_(recording.indicators)
  {
    const auto lock = lockLibrary();
    const Hdf5Handle creation = withoutTimes(H5P_FILE_CREATE);
    file_ = Hdf5Handle(H5Fcreate(temporary_.c_str(), H5F_ACC_TRUNC, creation.get(), H5P_DEFAULT), H5Fclose);
    if (!file_.valid() || !writeFaults(file_.get(), faults_, spec.arm))
    {
      fail();
    }
    writeParameters(spec);
    if (twin == nullptr)
    {
      return;
    }
    begin_ = twin->stamp();
    from_ = begin_ + toStampLength(recording.start);
    teeth_ = twin->makeToothForces();
    for (const RecordingGroup& group : recording.groups)
    {
      makeGroup(group, spec, recording.start, recording.deflate);
    }
  }

  ~Hdf5RunFile() override
  {
    close();
    std::remove(temporary_.c_str());
  }

  void record(Twin& twin, const DutyFeeder& feeder) override
  {
    const Stamp now = twin.stamp();
    if (indicators_ && twin.signalIndicators().windows > windows_.size())
    {
      windows_.push_back(twin.signalIndicators());
    }
    for (Group& group : groups_)
    {
      if (!isDue(group, now))
      {
        continue;
      }
      const Instant instant{ twin.outputs(), twin.encoders(), twin.motorTorqueReading(), feeder.speedReference() };
      const bool teeth_known = !group.per_tooth || twin.toothForces(teeth_);
      rows_without_forces_ += teeth_known ? 0 : 1;
      const double time = toSeconds(now - begin_);
      for (ColumnData& data : group.columns)
      {
        if (data.column == nullptr)
        {
          data.block.push_back(&data == &group.columns.back() ? severityAt(time, 0) : time);
        }
        else if (data.column->per_tooth != nullptr && !teeth_known)
        {
          data.block.insert(data.block.end(), data.width, std::numeric_limits<double>::quiet_NaN());
        }
        else if (data.column->per_tooth != nullptr)
        {
          const std::vector<double>& row = teeth_.*data.column->per_tooth;
          data.block.insert(data.block.end(), row.begin(), row.end());
        }
        else
        {
          data.block.push_back(data.column->value(instant));
        }
      }
      finishRow(group);
    }
  }

  void record(Stamp now, ArmRecorder& arm) override
  {
    for (Group& group : groups_)
    {
      if (!isDue(group, now))
      {
        continue;
      }
      const ArmRow& row = arm.row();
      const double time = toSeconds(now - begin_);
      for (ColumnData& data : group.columns)
      {
        if (data.column != nullptr)
        {
          const auto& numbers = row[static_cast<std::size_t>(data.column - armColumns().data())];
          data.block.insert(data.block.end(), numbers.begin(), numbers.end());
          continue;
        }
        for (std::size_t i = 0; i < data.width; ++i)
        {
          data.block.push_back(data.is_table ? severityAt(time, i) : time);
        }
      }
      finishRow(group);
    }
  }

  void finish(OrderedJson record) override
  {
    record[ROWS_WITHOUT_FORCES] = rows_without_forces_;
    for (Group& group : groups_)
    {
      if (group.buffered > 0)
      {
        flush(group);
      }
      const auto lock = lockLibrary();
      for (ColumnData& data : group.columns)
      {
        const hsize_t extent[2] = { group.written, data.width };
        check(H5Dset_extent(data.dataset.get(), extent));  // smaller than planned if the run was stopped
      }
    }
    {
      const auto lock = lockLibrary();
      for (const char* key : { "run", "class", "duty", "status", "error", "version", ROWS_WITHOUT_FORCES })
      {
        writeAttribute(key, record.at(key));
      }
      for (const char* key : { DriveSplit::DRIVE, DriveSplit::SPLIT })
      {
        writeAttribute(key, record.at("variables").value(key, OrderedJson()));
      }
      if (indicators_)
      {
        writeIndicators();
      }
      if (!writeTextDataset(file_.get(), "record", record.dump()))
      {
        fail();
      }
      groups_.clear();
      check(H5Fflush(file_.get(), H5F_SCOPE_LOCAL));
      file_ = Hdf5Handle();
    }
    sealFile(temporary_);
    bringToDisk(temporary_, path_);
  }

private:
  struct ColumnData
  {
    const RunColumn* column;  // null: time or severity
    bool is_table;
    Hdf5Handle dataset;
    std::size_t width;  // numbers per row
    std::vector<double> block;
  };
  struct Group
  {
    bool float32;
    Stamp period;  // period of the rows [ns]
    hsize_t rows_in_block;
    hsize_t buffered{};
    hsize_t written{};
    bool per_tooth{};
    std::vector<ColumnData> columns{};
  };

  /// Writes an entry of the record as an attribute, if the entry is a text or a number.
  void writeAttribute(const char* key, const OrderedJson& value)
  {
    if (value.is_number())
    {
      writeNumber(file_.get(), key, value.get<double>());
    }
    else if (value.is_string())
    {
      writeText(file_.get(), key, value.get<std::string>());
    }
  }

  /// Writes the parameters; for an arm, as a group with the parameters of each drive under the name of its joint.
  void writeParameters(const RunSpec& spec)
  {
    if (!spec.arm)
    {
      check(writeTextDataset(file_.get(), "parameters", describeParameters(spec.parameters)) ? 0 : -1);
      return;
    }
    const Hdf5Handle properties = withoutTimes(H5P_GROUP_CREATE);
    const Hdf5Handle group(H5Gcreate2(file_.get(), "parameters", H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Gclose);
    check(group.get());
    for (std::size_t i = 0; i < joints_; ++i)
    {
      const char* name = spec.arm->arm.joints[i].short_name.c_str();
      check(writeTextDataset(group.get(), name, describeParameters(spec.arm->drives[i])) ? 0 : -1);
    }
  }

  void makeGroup(const RecordingGroup& recorded, const RunSpec& spec, double start, int deflate)
  {
    const auto rows = static_cast<hsize_t>(std::floor((spec.duration - start) * recorded.rate + 1e-6));
    const hsize_t chunks = std::max<hsize_t>(1, (rows + ROWS_IN_CHUNK - 1) / ROWS_IN_CHUNK);
    Group group{ recorded.float32, publishPeriod(recorded.rate, spec.parameters.solver.rate),
                 std::max<hsize_t>(1, (rows + chunks - 1) / chunks) };
    const Hdf5Handle properties = withoutTimes(H5P_GROUP_CREATE);
    const Hdf5Handle place(H5Gcreate2(file_.get(), recorded.name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                           H5Gclose);
    check(place.get());
    writeNumber(place.get(), "sample_rate", recorded.rate);
    writeText(place.get(), "sample_rate_unit", "Hz");
    writeNumber(place.get(), "first_time", start + 1.0 / recorded.rate);
    writeText(place.get(), "first_time_unit", "s");
    const auto add = [&](const RunColumn* column, std::size_t width, bool is_table,
                         const std::array<const char*, 3>& text, hid_t type)
    {
      const hsize_t extent[2] = { rows, width };
      const hsize_t chunk[2] = { group.rows_in_block, width };
      const hsize_t most[2] = { H5S_UNLIMITED, width };
      const int rank = is_table ? 2 : 1;
      const Hdf5Handle creation = withoutTimes(H5P_DATASET_CREATE);
      H5Pset_chunk(creation.get(), rank, chunk);
      if (deflate > 0)
      {
        H5Pset_shuffle(creation.get());
        H5Pset_deflate(creation.get(), static_cast<unsigned>(deflate));
      }
      const Hdf5Handle space(H5Screate_simple(rank, extent, most), H5Sclose);
      Hdf5Handle dataset(H5Dcreate2(place.get(), text[0], type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                         H5Dclose);
      check(dataset.get());
      writeText(dataset.get(), "unit", text[1]);
      writeText(dataset.get(), "meaning", text[2]);
      group.per_tooth = group.per_tooth || (column != nullptr && column->per_tooth != nullptr);
      group.columns.push_back({ column, is_table, std::move(dataset), width, {} });
      group.columns.back().block.reserve(group.rows_in_block * width);
    };
    for (const RunColumn* column : recorded.columns)
    {
      const std::size_t width = column->width(spec.parameters.gear.teeth_flexspline, joints_);
      add(column, width, column->isTable(), { column->name, column->unit, column->meaning },
          group.float32 ? H5T_IEEE_F32LE : H5T_IEEE_F64LE);
    }
    // Time and severity follow after the columns of the plan.
    add(nullptr, 1, false, { TIME, "s", "time since the start of the run" }, H5T_IEEE_F64LE);
    add(nullptr, joints_, spec.arm.has_value(),
        { SEVERITY, "-", "largest severity of the drive's faults at this instant; 0: sound" }, H5T_IEEE_F32LE);
    groups_.push_back(std::move(group));
  }

  bool isDue(const Group& group, Stamp now) const { return now > from_ && (now - from_) % group.period == 0; }

  /// Largest severity of a joint's faults at a time [-].
  double severityAt(double time, std::size_t joint) const
  {
    double largest = 0.0;
    for (const RunFault& growing : faults_)
    {
      largest = growing.joint == joint ? std::max(largest, growing.severityAt(time)) : largest;
    }
    return largest;
  }

  void finishRow(Group& group)
  {
    if (++group.buffered == group.rows_in_block)
    {
      flush(group);
    }
  }

  void flush(Group& group)
  {
    const auto lock = lockLibrary();
    for (ColumnData& data : group.columns)
    {
      const int rank = data.is_table ? 2 : 1;
      const hsize_t first[2] = { group.written, 0 };
      const hsize_t count[2] = { group.buffered, data.width };
      const Hdf5Handle space(H5Dget_space(data.dataset.get()), H5Sclose);
      const Hdf5Handle memory(H5Screate_simple(rank, count, nullptr), H5Sclose);
      check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, first, nullptr, count, nullptr));
      check(H5Dwrite(data.dataset.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, data.block.data()));
      data.block.clear();
    }
    group.written += group.buffered;
    group.buffered = 0;
  }

  void writeIndicators()
  {
    const Hdf5Handle properties = withoutTimes(H5P_GROUP_CREATE);
    const Hdf5Handle group(H5Gcreate2(file_.get(), "indicators", H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Gclose);
    check(group.get());
    const auto write = [&](const char* name, const char* unit, const auto& value)
    {
      std::vector<double> rows;
      for (const SignalIndicators& window : windows_)
      {
        rows.push_back(value(window));
      }
      check(writeRows(group.get(), name, unit, rows));
    };
    using W = const SignalIndicators&;
    const auto end_of = [this](W w) { return toSeconds(w.stamp - begin_); };
    const double first = toSeconds(from_ - begin_);
    write("window_start", "s",  // end of the previous window
          [&](W w) { return w.windows > 1 ? end_of(windows_[static_cast<std::size_t>(w.windows - 2)]) : first; });
    write("window_end", "s", end_of);
    write("window_severity", "-", [&](W w) { return severityAt(end_of(w), 0); });
    write("window_turns", "-", [](W w) { return w.turns; });
    write("window_speed", "rad/s", [](W w) { return w.point.speed; });
    write("window_direction", "-", [](W w) { return w.point.direction; });
    write("window_load", "N.m", [](W w) { return w.point.load; });
    write("window_load_constant", "N.m", [](W w) { return w.point.load_constant; });
    write("window_load_sine", "N.m", [](W w) { return w.point.load_sine; });
    write("window_load_cosine", "N.m", [](W w) { return w.point.load_cosine; });
    write("window_inertia", "kg.m^2", [](W w) { return w.point.inertia; });
    write("window_temperature", "degC", [](W w) { return w.point.temperature; });
    for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
    {
      write(indicatorName(i), indicatorUnit(i), [i](W w) { return w.values[i]; });
    }
    for (std::size_t i = SCALAR_COUNT; i < INDICATOR_COUNT; ++i)
    {
      if (amplitudeOf(i) == i)
      {
        write(errorColumn(i).c_str(), indicatorUnit(i), [i](W w) { return w.uncertainty[i]; });
      }
    }
  }

  void close() noexcept
  {
    const auto lock = lockLibrary();
    groups_.clear();
    file_ = Hdf5Handle();
  }

  [[noreturn]] void fail() const { throw InputError(path_ + " cannot be written"); }

  hid_t check(hid_t result) const
  {
    if (result < 0)
    {
      fail();
    }
    return result;
  }

  std::string path_;
  std::string temporary_;
  Hdf5Handle file_;
  Stamp from_{};  // stamp after which instants are recorded [ns]
  Stamp begin_{};
  std::vector<RunFault> faults_;
  std::size_t joints_;
  ToothForces teeth_;
  std::uint64_t rows_without_forces_{};
  std::vector<Group> groups_;
  bool indicators_;
  std::vector<SignalIndicators> windows_;
};

std::vector<std::string> namesIn(hid_t group)
{
  std::vector<std::string> found;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t
  {
    static_cast<std::vector<std::string>*>(into)->emplace_back(name);
    return 0;
  };
  H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &found);
  return found;
}

/// Columns with one number per row. `place` is for the text of an error.
Columns columnsOf(hid_t group, const std::string& place)
{
  Columns columns;
  for (const std::string& column : namesIn(group))
  {
    const Hdf5Handle dataset(H5Dopen2(group, column.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
    if (H5Sget_simple_extent_ndims(space.get()) != 1)
    {
      continue;  // in this column, a row has one number for each tooth
    }
    std::vector<double> rows(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    if (H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0)
    {
      throw InputError(place + "/" + column + " cannot be read");
    }
    columns[column] = std::move(rows);
  }
  return columns;
}
}  // namespace

std::unique_ptr<RunFile> makeHdf5RunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                         const std::string& path)
{
  return std::make_unique<Hdf5RunFile>(recording, spec, twin, path);
}

bool hasHdf5()
{
  return true;
}

std::string readHdf5Text(const std::string& path, const char* name)
{
  const auto lock = lockLibrary();
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid())
  {
    return {};
  }
  const Hdf5Handle dataset(H5Dopen2(file.get(), name, H5P_DEFAULT), H5Dclose);
  if (!dataset.valid())
  {
    return {};
  }
  const Hdf5Handle type(H5Dget_type(dataset.get()), H5Tclose);
  std::string text(H5Tget_size(type.get()), '\0');
  const bool read = H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0;
  return read ? text : std::string();
}

Columns readHdf5Columns(const std::string& path, const std::vector<std::string>& holding)
{
  const auto lock = lockLibrary();
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid())
  {
    throw InputError(path + " cannot be read as HDF5");
  }
  for (const std::string& name : namesIn(file.get()))
  {
    const Hdf5Handle group(H5Gopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Gclose);
    const auto holds = [&](const std::string& wanted)
    { return H5Lexists(group.get(), wanted.c_str(), H5P_DEFAULT) > 0; };
    if (group.valid() && std::any_of(holding.begin(), holding.end(), holds))
    {
      return columnsOf(group.get(), path + ": " + name);
    }
  }
  return {};
}
}  // namespace hjt
