// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/run_file.hpp"

#include <filesystem>
#include <optional>

#include "datasets/bag_run_file.hpp"
#include "datasets/hdf5_files.hpp"

#include "arm/moving_arm.hpp"
#include "base/number_text.hpp"
#include "health/indicator_table.hpp"

namespace hjt
{
std::unique_ptr<RunFile> makeRunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                     const std::string& path)
{
  if (recording.format == RunFormat::BAG)
  {
    return std::make_unique<BagRunFile>(spec, twin, path);
  }
  return makeHdf5RunFile(recording, spec, twin, path);
}

void addOutcome(const TwinCounters& counters, std::uint64_t on_surface, double end, OrderedJson& record)
{
  if (counters.solver_failures > 0)
  {
    record["status"] = "failed";
    record["error"] = "the solver found no equilibrium at " + numberText(end) + " s; the record ends there";
  }
  record["steps"] = counters.steps;
  record["steps_on_surface"] = on_surface;
  record["coarse_steps"] = counters.coarse_steps;
  record["torque_clamped"] = counters.torque_clamped;
  record["jumps"] = counters.jumps;
}

void addProtectiveStop(const ArmDescription& arm, const MovingArm& moving, OrderedJson& record)
{
  const std::optional<ProtectiveStop>& stop = moving.protectiveStop();
  record[PROTECTIVE_STOP] = stop ? arm.joints[stop->joint].short_name + " " + stop->reason + " at " +
                                       numberText(toSeconds(stop->stamp - moving.motionBegin())) + " s" :
                                   "";
}

const char* runFileExtension(RunFormat format)
{
  return format == RunFormat::BAG ? ".bag" : ".h5";
}

OrderedJson readRunRecord(RunFormat format, const std::string& path)
{
  if (!std::filesystem::exists(path))
  {
    return nullptr;
  }
  const std::string text = format == RunFormat::BAG ? BagRunFile::readRecord(path) : readHdf5Text(path, "record");
  return OrderedJson::parse(text, nullptr, false);
}

std::string readRunParameters(const std::string& path)
{
  return readHdf5Text(path, "parameters");
}

Columns readRunColumns(const std::string& path, const std::vector<std::string>& holding)
{
  return readHdf5Columns(path, holding);
}

std::string errorColumn(std::size_t indicator)
{
  return std::string("window_error_") + indicatorName(amplitudeOf(indicator));
}

double dataSize(const Recording& recording, const RunSpec& spec)
{
  const std::size_t joints = spec.arm ? spec.arm->drives.size() : 1;
  double bytes = 0.0;
  for (const RecordingGroup& group : recording.groups)
  {
    for (const RunColumn* column : group.columns)
    {
      const auto numbers = static_cast<double>(column->width(spec.parameters.gear.teeth_flexspline, joints));
      bytes += (spec.duration - recording.start) * group.rate * numbers * (group.float32 ? 4.0 : 8.0);
    }
  }
  return bytes;
}
}  // namespace hjt
