// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_run.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "output/output_file.hpp"
#include "output/run_summary.hpp"
#include "recordings/rms.hpp"
#include "recordings/set_points.hpp"

#include "arm/arm_configuration.hpp"
#include "arm/moving_arm.hpp"
#include "base/number_text.hpp"

namespace hjt
{
namespace
{
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
  giveOwnSeeds(drives);
  addArmFaults(arm, options.faults, drives);
  return drives;
}

/// How the steps of all drives went.
TwinCounters countersOf(const ArmTwin& twin)
{
  TwinCounters sum;
  for (std::size_t i = 0; i < twin.joints(); ++i)
  {
    const TwinCounters& drive = twin.drive(i).counters();
    for (std::uint64_t TwinCounters::*count :
         { &TwinCounters::solver_failures, &TwinCounters::step_cuts, &TwinCounters::jumps, &TwinCounters::coarse_steps,
           &TwinCounters::torque_clamped, &TwinCounters::overloads, &TwinCounters::speed_limited })
    {
      sum.*count += drive.*count;
    }
  }
  return sum;
}

std::vector<std::string> columnsOf(std::size_t joints)
{
  std::vector<std::string> columns{ "timestamp" };
  for (const ArmRunQuantity& quantity : armRunQuantities(joints))
  {
    for (std::size_t i = 0; i < quantity.width; ++i)
    {
      columns.push_back(quantity.name + std::to_string(i));
    }
  }
  return columns;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Makes the rows of a moving arm, and adds up its errors.
class Recorder
{
public:
  Recorder(const ArmDescription& arm, MovingArm& moving)
    : arm_(moving), dynamics_(arm), target_(arm.joints.size()), joints_(arm.joints.size())
  {
    for (std::size_t i = 0; i < joints_.size(); ++i)
    {
      joints_[i].name = arm.joints[i].short_name;
      Parameters drive = moving.twin().drive(i).parameters();
      inertia_in_load_.push_back(takeInertiaInLoad(drive));
    }
  }

  const std::vector<double>& row(double time)
  {
    arm_.wanted(target_);
    row_.assign(1, time);
    std::array<std::vector<double>, 8> values;
    for (std::size_t i = 0; i < target_.size(); ++i)
    {
      const std::array<double, 8> numbers = numbersOf(i);
      for (std::size_t k = 0; k < values.size(); ++k)
      {
        values[k].push_back(numbers[k]);
      }
      addErrors(i, numbers.back());
    }
    for (const std::vector<double>& value : values)
    {
      row_.insert(row_.end(), value.begin(), value.end());
    }
    const ToolPose wanted = dynamics_.toolPose(target_);
    const ToolPose tool = arm_.twin().toolPose();
    for (const ToolPose& pose : { wanted, tool })
    {
      row_.insert(row_.end(), pose.position.begin(), pose.position.end());
    }
    const double error = distance(tool.position, wanted.position);
    tool_.add(error);
    tool_largest_ = std::max(tool_largest_, error);
    return row_;
  }

  ArmRun finish()
  {
    ArmRun run;
    run.tool_error_rms = tool_.value();
    run.tool_error_max = tool_largest_;
    for (const JointErrors& joint : joints_)
    {
      run.joints.push_back({ joint.name, joint.angle.value(), joint.largest_angle, joint.current.value() });
    }
    return run;
  }

private:
  struct JointErrors
  {
    std::string name;
    Rms angle;               // [rad]
    double largest_angle{};  // [rad]
    Rms current;             // [A]
  };

  /// Of a joint, in the order of the columns.
  std::array<double, 8> numbersOf(std::size_t i) const
  {
    const ArmController& controller = arm_.controller();
    const double gain = arm_.twin().drive(i).parameters().telemetry.torque_per_current;
    const JointReading read = arm_.reading(i);
    const JointMotion& target = target_[i];
    return { target.position,
             target.velocity,
             target.acceleration,
             controller.feedForward(i) / gain,
             controller.rigidTorques()[i] + inertia_in_load_[i] * target.acceleration,
             read.position,
             read.velocity,
             read.current };
  }

  void addErrors(std::size_t i, double current)
  {
    JointErrors& joint = joints_[i];
    const double error = arm_.twin().motion()[i].position - target_[i].position;
    joint.angle.add(error);
    joint.largest_angle = std::max(joint.largest_angle, std::abs(error));
    joint.current.add(current);
  }

  MovingArm& arm_;
  ArmDynamics dynamics_;
  std::vector<JointMotion> target_;
  std::vector<double> inertia_in_load_;
  std::vector<JointErrors> joints_;
  std::vector<double> row_;
  Rms tool_;               // [m]
  double tool_largest_{};  // [m]
};
}  // namespace

std::vector<ArmRunQuantity> armRunQuantities(std::size_t joints)
{
  constexpr std::size_t AXES = 3;
  return { { "target_q_", joints },       { "target_qd_", joints },      { "target_qdd_", joints },
           { "target_current_", joints }, { "target_moment_", joints },  { "actual_q_", joints },
           { "actual_qd_", joints },      { "actual_current_", joints }, { "target_TCP_pose_", AXES },
           { "actual_TCP_pose_", AXES } };
}

ArmRun runArm(const ArmRunOptions& options)
try
{
  requireWritable(options.out, options.force, options.motion);
  ArmDescription arm = readArmDescription(findArm(options.arm, configDirectory(options)));
  addIdentifiedGains(options.identified, arm);
  std::vector<ArmSetPoint> points =
      options.set_points.empty() ? readSetPoints(options.motion, arm) : options.set_points;
  if (const double change = straightenTimes(points); change > 0.0)
  {
    options.watch.notice("the set points' times do not go with their angles and speeds: moved, a step by up to " +
                         fixedText(1e3 * change, 1) + " ms");
  }
  ArmMotion motion(std::move(points));
  MovingArm moving(arm, drivesOf(options, arm), motion, surfaceSource(options.watch));
  Recorder recorder(arm, moving);
  std::optional<CsvWriter> csv;
  if (!options.out.empty())
  {
    csv.emplace(options.out, columnsOf(arm.joints.size()));
  }
  moving.reset(SIMULATION_EPOCH);
  ArmTwin& twin = moving.twin();
  const Stamp end = moving.motionBegin() + toStampLength(motion.end() - motion.begin());
  const double rate = options.rate.value_or(arm.state_rate);
  const auto row_steps = std::max(std::llround(1e9 / rate / static_cast<double>(twin.stepLength())), 1LL);
  const auto progress = options.watch.progress("moving the arm");
  const auto started = std::chrono::steady_clock::now();
  std::int64_t steps = 0;
  while (!options.watch.stopped() && moving.step(end))
  {
    if (twin.stamp() >= moving.motionBegin() && steps++ % row_steps == 0)
    {
      const std::vector<double>& row = recorder.row(motion.begin() + toSeconds(twin.stamp() - moving.motionBegin()));
      options.take(row);
      if (csv)
      {
        csv->writeRow(row);
      }
    }
    progress(static_cast<double>(twin.stamp() - SIMULATION_EPOCH) / static_cast<double>(end - SIMULATION_EPOCH));
  }
  if (csv)
  {
    csv->close();
  }
  ArmRun run = recorder.finish();
  run.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  run.duration = toSeconds(twin.stamp() - SIMULATION_EPOCH);
  run.energy_residual = twin.energyResidual();
  run.counters = countersOf(twin);
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
    { "angle_error_rms", [](const ArmRunJoint& joint) { return 1e3 * joint.angle_error_rms; },
      "angle error, rms [mrad]" },
    { "angle_error_max", [](const ArmRunJoint& joint) { return 1e3 * joint.angle_error_max; }, "largest [mrad]" },
    { "current_rms", &ArmRunJoint::current_rms, "current, rms [A]" }
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
             { "tool_error_rms", "tool position error, rms [mm]", 1e3 * run.tool_error_rms },
             { "tool_error_max", "largest [mm]", 1e3 * run.tool_error_max },
             { "energy_residual", "error of the arm's energy [J]", run.energy_residual },
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
