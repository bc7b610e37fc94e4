// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "apps/common/surface_source.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/run_summary.hpp"

#include "arm/arm_configuration.hpp"
#include "arm/moving_arm.hpp"
#include "base/csv_rows.hpp"
#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
struct ArmRunOptions : CommonOptions
{
  std::string motion;
  std::string arm;
  std::string identified;
  std::string out;
  std::optional<double> rate;  // [Hz]
};

/// The column of a header by one of its names; -1: none.
int columnOf(const std::vector<std::string>& header, const std::vector<std::string>& names)
{
  for (const std::string& name : names)
  {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found != header.end())
    {
      return static_cast<int>(found - header.begin());
    }
  }
  return -1;
}

/// Rates that a file does not give, by differences of its angles.
void fillRates(std::vector<ArmSetPoint>& points, bool has_velocity, bool has_acceleration)
{
  const auto slope = [&](std::size_t k, std::size_t i, double JointMotion::*value)
  {
    const ArmSetPoint& before = points[k > 0 ? k - 1 : k];
    const ArmSetPoint& after = points[std::min(k + 1, points.size() - 1)];
    return after.time > before.time ? (after.joints[i].*value - before.joints[i].*value) / (after.time - before.time) :
                                      0.0;
  };
  for (const auto& [missing, of, rate] :
       { std::tuple(!has_velocity, &JointMotion::position, &JointMotion::velocity),
         std::tuple(!has_acceleration, &JointMotion::velocity, &JointMotion::acceleration) })
  {
    for (std::size_t k = 0; missing && k < points.size(); ++k)
    {
      for (std::size_t i = 0; i < points[k].joints.size(); ++i)
      {
        points[k].joints[i].*rate = slope(k, i, of);
      }
    }
  }
}

/// Set points of a CSV file: those of a controller's recording, or a motion as `joint_twin checkup` writes it.
std::vector<ArmSetPoint> readSetPoints(const std::string& path, const ArmDescription& arm)
{
  CsvRows rows(path);
  const std::vector<std::string>& header = rows.header();
  const int time = columnOf(header, { "timestamp", "time" });
  std::vector<std::array<int, 3>> columns;
  std::string missing = time < 0 ? "timestamp or time" : "";
  bool has_velocity = true;
  bool has_acceleration = true;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    const std::string number = std::to_string(i);
    const std::string& name = arm.joints[i].short_name;
    columns.push_back({ columnOf(header, { "target_q_" + number, name + "_position" }),
                        columnOf(header, { "target_qd_" + number, name + "_velocity" }),
                        columnOf(header, { "target_qdd_" + number, name + "_acceleration" }) });
    if (columns[i][0] < 0)
    {
      missing += (missing.empty() ? "" : ", ") + ("target_q_" + number + " or " + name + "_position");
    }
    has_velocity = has_velocity && columns[i][1] >= 0;
    has_acceleration = has_acceleration && columns[i][2] >= 0;
  }
  if (!missing.empty())
  {
    throw InputError(path + ": no column " + missing);
  }
  std::vector<ArmSetPoint> points;
  const auto number = [&](int column)
  {
    const std::optional<double> value = decimalNumber(rows.text(static_cast<std::size_t>(column)));
    if (!value || !std::isfinite(*value))
    {
      throw InputError(rows.place() + ": column '" + header[static_cast<std::size_t>(column)] +
                       "' is no finite number");
    }
    return *value;
  };
  while (rows.next())
  {
    ArmSetPoint point{ number(time), {} };
    for (const std::array<int, 3>& column : columns)
    {
      point.joints.push_back(
          { number(column[0]), has_velocity ? number(column[1]) : 0.0, has_acceleration ? number(column[2]) : 0.0 });
    }
    if (!points.empty() && point.time <= points.back().time)
    {
      throw InputError(rows.place() + ": the time does not go on, " + numberText(point.time) + " s after " +
                       numberText(points.back().time) + " s");
    }
    points.push_back(point);
  }
  if (points.empty())
  {
    throw InputError(path + " has no row");
  }
  fillRates(points, has_velocity, has_acceleration);
  return points;
}

std::vector<Parameters> drivesOf(const ArmRunOptions& options, const ArmDescription& arm)
{
  std::vector<Parameters> drives;
  for (const ArmJoint& joint : arm.joints)
  {
    ParameterMap map = armJointParameters(joint, configDirectory(options), options.identified);
    readAssignment("solver.scene=auto", map);
    addOverlays(options, map);
    drives.push_back(parseParameters(map));
  }
  addArmFaults(arm, options.faults, drives);
  return drives;
}

/// What the report says of a joint.
struct JointErrors
{
  std::string name;
  double squares{};  // of actual less target angle [rad^2]
  double largest{};
  double current_squares{};  // [A^2]
};

/// Rows as a controller's recording has them.
class Recorder
{
public:
  Recorder(const ArmRunOptions& options, const ArmDescription& arm, MovingArm& moving)
    : arm_(moving), dynamics_(arm), target_(arm.joints.size()), csv_(options.out, columnsOf(arm.joints.size()))
  {
    for (std::size_t i = 0; i < arm.joints.size(); ++i)
    {
      errors_.push_back({ arm.joints[i].short_name });
      Parameters drive = moving.twin().drive(i).parameters();
      inertia_in_load_.push_back(takeInertiaInLoad(drive));
    }
  }

  void record(double time)
  {
    arm_.wanted(target_);
    const ArmController& controller = arm_.controller();
    std::vector<double> row{ time };
    std::array<std::vector<double>, 8> values;
    for (std::size_t i = 0; i < target_.size(); ++i)
    {
      const double gain = arm_.twin().drive(i).parameters().telemetry.torque_per_current;
      const JointReading read = arm_.reading(i);
      const double numbers[] = { target_[i].position,
                                 target_[i].velocity,
                                 target_[i].acceleration,
                                 controller.feedForward(i) / gain,
                                 controller.rigidTorques()[i] + inertia_in_load_[i] * target_[i].acceleration,
                                 read.position,
                                 read.velocity,
                                 read.current };
      for (std::size_t k = 0; k < values.size(); ++k)
      {
        values[k].push_back(numbers[k]);
      }
      JointErrors& errors = errors_[i];
      const double error = arm_.twin().motion()[i].position - target_[i].position;
      errors.squares += error * error;
      errors.largest = std::max(errors.largest, std::abs(error));
      errors.current_squares += read.current * read.current;
    }
    for (const std::vector<double>& value : values)
    {
      row.insert(row.end(), value.begin(), value.end());
    }
    const ToolPose wanted = dynamics_.toolPose(target_);
    const ToolPose tool = arm_.twin().toolPose();
    double square = 0.0;
    for (const ToolPose& pose : { wanted, tool })
    {
      row.insert(row.end(), pose.position.begin(), pose.position.end());
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      square += (tool.position[k] - wanted.position[k]) * (tool.position[k] - wanted.position[k]);
    }
    tool_squares_ += square;
    tool_largest_ = std::max(tool_largest_, std::sqrt(square));
    csv_.writeRow(row);
    ++rows_;
  }

  void close() { csv_.close(); }

  void report(const ArmRunOptions& options, double duration, double wall)
  {
    const auto n = static_cast<double>(std::max<std::size_t>(rows_, 1));
    const std::vector<Column<JointErrors>> columns{
      { "joint", &JointErrors::name, "joint" },
      { "angle_error_rms", [n](const JointErrors& e) { return Json(1e3 * std::sqrt(e.squares / n)); },
        "angle error, rms [mrad]" },
      { "angle_error_max", [](const JointErrors& e) { return Json(1e3 * e.largest); }, "largest [mrad]" },
      { "current_rms", [n](const JointErrors& e) { return Json(std::sqrt(e.current_squares / n)); },
        "current, rms [A]" },
    };
    printReport(options.json,
                { { "output", "", options.out },
                  { "duration", "duration [s]", duration },
                  { "real_time_factor", "times real time", duration / wall },
                  { "tool_error_rms", "tool position error, rms [mm]", 1e3 * std::sqrt(tool_squares_ / n) },
                  { "tool_error_max", "largest [mm]", 1e3 * tool_largest_ },
                  { "energy_residual", "error of the arm's energy [J]", arm_.twin().energyResidual() } },
                { { "joints", Table(columns, errors_) } });
  }

private:
  static std::vector<std::string> columnsOf(std::size_t joints)
  {
    std::vector<std::string> columns{ "timestamp" };
    for (const char* quantity : { "target_q_", "target_qd_", "target_qdd_", "target_current_", "target_moment_",
                                  "actual_q_", "actual_qd_", "actual_current_" })
    {
      for (std::size_t i = 0; i < joints; ++i)
      {
        columns.push_back(quantity + std::to_string(i));
      }
    }
    for (const char* pose : { "target_TCP_pose_", "actual_TCP_pose_" })
    {
      for (int i = 0; i < 3; ++i)
      {
        columns.push_back(pose + std::to_string(i));
      }
    }
    return columns;
  }

  MovingArm& arm_;
  ArmDynamics dynamics_;
  std::vector<JointMotion> target_;
  std::vector<double> inertia_in_load_;
  std::vector<JointErrors> errors_;
  double tool_squares_{};
  double tool_largest_{};
  std::size_t rows_{};
  CsvWriter csv_;
};

int runArm(const ArmRunOptions& options)
{
  requireWritable(options.out, options.force, options.motion);
  const ArmDescription arm = readArmDescription(findArm(options.arm, configDirectory(options)));
  ArmMotion motion(readSetPoints(options.motion, arm));
  MovingArm moving(arm, drivesOf(options, arm), motion, surfaceSource());
  Recorder recorder(options, arm, moving);
  moving.reset(SIMULATION_EPOCH);
  ArmTwin& twin = moving.twin();
  const Stamp end = moving.motionBegin() + toStampLength(motion.end() - motion.begin());
  const double rate = options.rate.value_or(arm.state_rate);
  const auto row_steps = std::llround(1e9 / rate / static_cast<double>(twin.stepLength()));
  const InterruptScope interrupts;
  const auto started = std::chrono::steady_clock::now();
  Progress progress("moving the arm");
  std::int64_t steps = 0;
  while (interruptSignal() == 0 && moving.step(end))
  {
    if (twin.stamp() >= moving.motionBegin() && steps++ % row_steps == 0)
    {
      recorder.record(motion.begin() + toSeconds(twin.stamp() - moving.motionBegin()));
    }
    progress.update(static_cast<double>(twin.stamp() - SIMULATION_EPOCH) / static_cast<double>(end - SIMULATION_EPOCH));
  }
  recorder.close();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  recorder.report(options, toSeconds(twin.stamp() - SIMULATION_EPOCH), wall);
  std::uint64_t failures = 0;
  for (std::size_t i = 0; i < twin.joints(); ++i)
  {
    failures += twin.drive(i).counters().solver_failures;
  }
  warn(failures, "steps without an equilibrium: the last good state was held");
  return reportWritten(options.out, options.json);
}

void declare(Command& command, ArmRunOptions& options)
{
  command
      .add("motion", options.motion,
           "set points: timestamp, target_q_0 ... and, if there, target_qd_0 ..., target_qdd_0 ... of a controller's "
           "recording, or as `joint_twin checkup` writes them")
      .required()
      .type("FILE.csv");
  command.add("--arm", options.arm, "name in config/arms, or a file").required().type("NAME|FILE.yaml");
  command.add("--identified", options.identified, "overlays of the joints, as `joint_twin identify --arm` writes them")
      .type("DIR")
      .existingDirectory();
  command
      .add("--out", options.out,
           "targets and actual angles, speeds, currents in a controller's columns, and the tool's position [m]")
      .required()
      .type("FILE.csv");
  command.add("--rate", options.rate, "of the rows [Hz]; default: that of the arm's states").positive();
  command.add("--fault", options.faults, "in a joint from its onset [s] on; may be given again")
      .type("JOINT:KIND:SEVERITY[:PLACE[:ONSET]]");
  addCommonOptions(command, options);
}

const Subcommand ARM{ Subject::JOINT, "arm", "run a whole arm in closed loop: its drives, links and controller",
                      declare, runArm };
}  // namespace
}  // namespace hjt
