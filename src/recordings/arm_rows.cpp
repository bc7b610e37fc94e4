// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_rows.hpp"

#include <filesystem>

#include "datasets/sweep_directory.hpp"

namespace hjt
{
ArmRows::ArmRows(const std::string& path, const RunSpec& spec, const MovingArm& moving)
  : moving_(moving), begin_(moving.twin().stamp()), end_(begin_), path_(path), spec_(spec)
{
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == runFileExtension(RunFormat::BAG) || ending == runFileExtension(RunFormat::HDF5))
  {
    Recording recording;
    recording.format = ending == runFileExtension(RunFormat::BAG) ? RunFormat::BAG : RunFormat::HDF5;
    RecordingGroup group{ "states", spec.arm->arm.state_rate, false, {} };
    for (const RunColumn& column : armColumns())
    {
      group.columns.push_back(&column);
    }
    recording.groups.push_back(group);
    file_ = makeRunFile(recording, spec, &moving.twin().drive(0), path);
  }
  else if (!path.empty())
  {
    std::vector<std::string> columns = armColumnNames(moving.twin().joints());
    columns.insert(columns.begin(), "timestamp");
    csv_.emplace(path, columns);
  }
}

void ArmRows::take(Stamp stamp, double time, ArmRecorder& recorder, const ArmRow* row)
{
  if (file_ && !failed_)
  {
    end_ = stamp;
    on_surface_ += stamp > begin_ && allOnSurface(moving_.twin()) ? 1 : 0;
    failed_ = countersOf(moving_.twin()).solver_failures > 0;
    if (!failed_)  // a failed twin ends the file here, as it ends a run of a data set
    {
      file_->record(stamp, recorder);
    }
  }
  if (csv_ && row != nullptr)
  {
    values_.assign(1, time);
    for (const std::vector<double>& numbers : *row)
    {
      values_.insert(values_.end(), numbers.begin(), numbers.end());
    }
    csv_->writeRow(values_);
  }
}

void ArmRows::close()
{
  if (file_)
  {
    OrderedJson record = recordOf(spec_, path_);
    addOutcome(countersOf(moving_.twin()), on_surface_, toSeconds(end_ - begin_), record);
    addProtectiveStop(spec_.arm->arm, moving_, record);
    file_->finish(record);
  }
  if (csv_)
  {
    csv_->close();
  }
}
}  // namespace hjt
