// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arm/arm_configuration.hpp"
#include "arm/arm_recorder.hpp"
#include "arm/moving_arm.hpp"
#include "arm/set_points.hpp"
#include "bags/recorded_messages.hpp"
#include "base/number_text.hpp"
#include "base/publish_period.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "datasets/run_file.hpp"
#include "datasets/sweep_directory.hpp"
#include "output/output_file.hpp"
#include "output/process_end.hpp"

namespace hjt
{
namespace
{
/// Writes the rows of an arm's motion to a file. A CSV file has one line for each row. A `.bag` file has the messages
/// that the arm's driver would publish. An `.h5` file has the layout of a run of a data set.
class ArmRows
{
public:
  /// `spec` describes the run. ArmSpec::arm.state_rate is the rate of the rows [Hz] and divides solver.rate. If `path`
  /// is empty, no file is written. `moving` is at the time of the first row and must live as long as this object.
  /// @throws InputError.
  ArmRows(const std::string& path, const RunSpec& spec, const MovingArm& moving)
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

  /// The caller calls this function after every step of the motion. `row` is null if no row is due. @throws InputError.
  void take(Stamp stamp, double time, ArmRecorder& recorder, const ArmRow* row)
  {
    if (file_ && !failed_)
    {
      end_ = stamp;
      on_surface_ += stamp > begin_ && allOnSurface(moving_.twin()) ? 1 : 0;
      failed_ = countersOf(moving_.twin()).solver_failures > 0;
      if (!failed_)  // as in a data set, the file ends where the solver of a twin fails
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

  /// @throws InputError.
  void close()
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

  /// Whether the file is a run, that is, a bag or an HDF5 file. Such a file exists only after `close`.
  bool isRun() const { return file_ != nullptr; }

private:
  const MovingArm& moving_;
  Stamp begin_;  // stamp of the first row
  Stamp end_;    // stamp of the last step
  bool failed_{};
  std::uint64_t on_surface_{};
  std::string path_;
  RunSpec spec_;
  std::unique_ptr<RunFile> file_;
  std::optional<CsvWriter> csv_;
  std::vector<double> values_;
};

/// Sets the arm's state_rate to the rate that divides solver.rate and is nearest to the wanted rate of rows [Hz].
void takeRate(const ArmRunOptions& options, double solver_rate, ArmDescription& arm)
{
  const double wanted = options.rate.value_or(arm.state_rate);
  arm.state_rate = solver_rate / static_cast<double>(publishSteps(wanted, solver_rate));
  if (std::abs(arm.state_rate / wanted - 1.0) > 1e-9)
  {
    options.watch.notice("rows at " + roundedText(arm.state_rate, 6) + " Hz in place of " + numberText(wanted) +
                         " Hz, which does not divide solver.rate = " + numberText(solver_rate) + " Hz");
  }
}

void addErrors(const ArmRow& row, const ArmTwin& twin, ArmRun& run)
{
  for (std::size_t i = 0; i < run.joints.size(); ++i)
  {
    run.joints[i].angle_error.add(twin.motion()[i].position - row[TARGET_POSITION][i]);
    run.joints[i].current.add(row[ACTUAL_CURRENT][i]);
  }
  const std::vector<double>& wanted = row[TARGET_TOOL];
  const std::vector<double>& tool = row[ACTUAL_TOOL];
  run.tool_error.add(std::hypot(tool[0] - wanted[0], tool[1] - wanted[1], tool[2] - wanted[2]));
}

RunSpec specOf(const ArmRunOptions& options, ArmDescription arm, std::vector<Parameters> drives,
               const ArmMotion& motion)
{
  RunSpec spec;
  spec.fault_class = options.faults.empty() ? "healthy" : joined(options.faults, ";");
  spec.duty_name = options.motion.empty() ? "motion" : options.motion;
  spec.duration = motion.end() - motion.begin();
  for (std::size_t joint = 0; joint < drives.size(); ++joint)
  {
    const std::vector<RunFault> more = configuredFaults(drives[joint], joint);
    spec.faults.insert(spec.faults.end(), more.begin(), more.end());
  }
  spec.parameters = drives.front();
  spec.arm = ArmSpec{ std::move(arm), std::move(drives), nullptr };
  return spec;
}

/// Moves the arm to the end of its motion and records every row.
void move(const ArmRunOptions& options, const ArmMotion& motion, MovingArm& moving, const RunSpec& spec, ArmRun& run)
{
  ArmTwin& twin = moving.twin();
  ArmRecorder recorder(spec.arm->arm, moving);
  std::optional<ArmRows> rows;
  const Stamp end = moving.motionBegin() + toStampLength(motion.end() - motion.begin());
  const auto row_steps = publishSteps(spec.arm->arm.state_rate, spec.parameters.solver.rate);
  const auto progress = options.watch.progress("moving the arm");
  std::int64_t steps = 0;
  while (!options.watch.stopped() && moving.step(end))
  {
    if (twin.stamp() >= moving.motionBegin())
    {
      if (!rows)
      {
        rows.emplace(options.out, spec, moving);
      }
      const double time = motion.begin() + toSeconds(twin.stamp() - moving.motionBegin());
      const ArmRow* row = steps++ % row_steps == 0 ? &recorder.row() : nullptr;
      if (row != nullptr)
      {
        addErrors(*row, twin, run);
        options.take(time, *row);
      }
      rows->take(twin.stamp(), time, recorder, row);
    }
    progress(static_cast<double>(twin.stamp() - SIMULATION_EPOCH) / static_cast<double>(end - SIMULATION_EPOCH));
  }
  if (rows && rows->isRun() && options.watch.stopped())
  {
    throw Stopped{};  // an incomplete run gets no file
  }
  if (rows)
  {
    rows->close();
  }
}
}  // namespace

void addOptions(OptionTable& table, ArmRunOptions& options)
{
  table
      .add("motion", options.motion,
           "a table of set points from a controller's recording or from `joint_twin checkup`: columns timestamp, "
           "target_q_0 ..., optional target_qd_0 ..., target_qdd_0 ...; or a YAML program of moves")
      .required()
      .type("FILE.csv|FILE.yaml");
  table.add("--arm", options.arm, "name of an arm in config/arms, or a file").required().type("NAME|FILE.yaml");
  table.add("--identified", options.identified, "overlays of the joints, as `joint_twin identify --arm` writes them")
      .type("DIR")
      .existingDirectory();
  table
      .add("--out", options.out,
           "every row; CSV: targets and actual values in a controller's columns, and the tool's position [m]; .bag: "
           "/joint_states as the arm's driver publishes it; .h5: as a run of `joint_twin sweep`")
      .type("FILE.csv|FILE.bag|FILE.h5");
  table.add("--rate", options.rate, "rate of the rows [Hz]; default: the rate of the arm's states")
      .range(ROW_RATE.min, ROW_RATE.max);
  table.add("--fault", options.faults, "a fault of a joint, which begins at its onset [s]; may be given several times")
      .type("JOINT:KIND:SEVERITY[:PLACE[:ONSET]]");
  addOptions(table, options, options.force);
}

ArmRun runArm(const ArmRunOptions& options)
try
{
  requireWritable(options.out, options.force, options.motion);
  ArmDescription arm = readArmDescription(findArm(options.arm, configDirectory(options)));
  addIdentifiedGains(options.identified, arm);
  if (options.set_points.empty())
  {
    requireTable(options.motion, "give a table of set points or a YAML program of moves");
  }
  std::vector<ArmSetPoint> points =
      options.set_points.empty() ? readSetPoints(options.motion, arm) : options.set_points;
  const std::string name = options.motion.empty() ? "motion" : options.motion;
  requireMotion(points, arm, name);
  requireRates(points, arm, name);
  if (const double change = straightenTimes(points); change > 0.0)
  {
    options.watch.notice(straightenedText(change));
  }
  ArmMotion motion(std::move(points));
  const std::vector<Parameters> drives = armDrives(arm, options, options.identified, options.faults);
  takeRate(options, drives.front().solver.rate, arm);
  MovingArm moving(arm, drives, motion, surfaceSource(options.watch));
  ArmRun run;
  for (const ArmJoint& joint : arm.joints)
  {
    run.joints.push_back({ joint.short_name, {}, {} });
  }
  moving.reset(SIMULATION_EPOCH);
  const auto started = std::chrono::steady_clock::now();
  move(options, motion, moving, specOf(options, arm, drives, motion), run);
  run.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  run.duration = toSeconds(moving.twin().stamp() - SIMULATION_EPOCH);
  run.energy_residual = moving.twin().energyResidual();
  run.counters = countersOf(moving.twin());
  run.feedback_limited = moving.controller().limitedControls();
  if (const std::optional<ProtectiveStop>& stop = moving.protectiveStop())
  {
    run.stop = { motion.begin() + toSeconds(stop->stamp - moving.motionBegin()), arm.joints[stop->joint].short_name,
                 stop->reason };
  }
  return run;
}
catch (const Stopped&)
{
  return {};
}

Report reportOf(const ArmRun& run)
{
  const std::vector<Column<ArmRunJoint>> columns{
    { "joint", &ArmRunJoint::name, "joint" },
    { "angle_error_rms", [](const ArmRunJoint& joint) { return 1e3 * joint.angle_error.rms(); },
      "angle error, rms [mrad]" },
    { "angle_error_max", [](const ArmRunJoint& joint) { return 1e3 * joint.angle_error.largest(); }, "largest [mrad]" },
    { "current_rms", [](const ArmRunJoint& joint) { return joint.current.value(); }, "current, rms [A]" }
  };
  const std::string stop =
      run.stop ? run.stop->joint + " " + run.stop->reason + " at " + roundedText(run.stop->time, 4) + " s" : "none";
  return { { { "duration", "duration [s]", run.duration },
             { "", "protective stop", stop },
             { "protective_stop", "",
               run.stop ?
                   Json{ { "joint", run.stop->joint }, { "reason", run.stop->reason }, { "time", run.stop->time } } :
                   Json() },
             { "real_time_factor", "times real time", run.duration / run.wall_time },
             { "tool_error_rms", "tool position error, rms [mm]", 1e3 * run.tool_error.rms() },
             { "tool_error_max", "largest [mm]", 1e3 * run.tool_error.largest() },
             { "energy_residual", "error of the arm's energy [J]", run.energy_residual },
             { "feedback_limited", "", run.feedback_limited },
             { "solver_failures", "", run.counters.solver_failures },
             { "step_cuts", "", run.counters.step_cuts },
             { "jumps", "", run.counters.jumps },
             { "coarse_steps", "", run.counters.coarse_steps },
             { "torque_clamped", "", run.counters.torque_clamped },
             { "speed_limited", "", run.counters.speed_limited },
             { "overloads", "", run.counters.overloads } },
           { { "joints", Table(columns, run.joints) } } };
}
}  // namespace hjt
