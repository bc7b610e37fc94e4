// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/arm_recording.hpp"

#include <iostream>

#include "output/interrupt.hpp"
#include "output/progress.hpp"

#include "arm/arm_configuration.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "tracking/effort.hpp"

namespace hjt
{
namespace
{
constexpr const char* FROM_ARM = "arm";
constexpr const char* FROM_RECORDING = "target_moment";

Parameters parametersOf(const ArmJoint& joint, const ArmOptions& options)
{
  ParameterMap map = armJointParameters(joint, configDirectory(options), options.identified);
  readAssignment("telemetry.load=" + options.load, map);
  addOverlays(options, map);
  Parameters parameters = parseParameters(map);
  addFaults(options, parameters);
  const LoadSource load = parameters.telemetry.load;
  if (load != LoadSource::TARGET_MOMENT && load != LoadSource::ARM)
  {
    throw ParameterError("telemetry.load: the load of an arm is chosen by --load");
  }
  return parameters;
}
}  // namespace

void addArmOption(Command& command, ArmOptions& options)
{
  command
      .add("--arm", options.arm,
           "all joints of an arm in place of one: ur3, ur5, ur10, ur3e, ur5e, ur10e, ur16e, or a file as "
           "config/arms/ur5.yaml")
      .type("NAME|FILE.yaml");
}

void addArmOptions(Command& command, ArmOptions& options)
{
  addRecordingOptions(command, options);
  options.load = FROM_ARM;
  addArmOption(command, options);
  command
      .add("--load", options.load,
           "load of an arm's joints: of its links and payload by rigid-body dynamics, or as recorded")
      .choice({ FROM_ARM, FROM_RECORDING })
      .needs("--arm");
  command
      .add("--identified", options.identified,
           "overlays of an arm's joints, as `joint_twin identify --arm` writes them, over the arm's own")
      .type("DIR")
      .existingDirectory()
      .needs("--arm");
  command.oneOf({ "--joint", "--arm" });
}

ArmRecording::ArmRecording(const ArmOptions& options)
  : source_(motionSource(options))
  , arm_(readArmDescription(findArm(options.arm, configDirectory(options))))
  , has_load_(recordsLoad(source_))
  , uses_recorded_(options.load == FROM_RECORDING)
{
  if (uses_recorded_ && !has_load_)
  {
    throw InputError(source_.path + " holds no load; --load arm needs none");
  }
  for (const ArmJoint& joint : arm_.joints)
  {
    Parameters& parameters = parameters_.emplace_back(parametersOf(joint, options));
    Parameters drive = parameters;
    inertias_in_load_.push_back(takeInertiaInLoad(drive));
    if (!uses_recorded_)
    {
      parameters = drive;
    }
  }
}

MotionSource ArmRecording::source(std::size_t joint) const
{
  MotionSource source = source_;
  source.joint = arm_.joints[joint].name;
  source.csv_joint = static_cast<int>(joint);
  return source;
}

void ArmRecording::warnOf(const RecordingFit& fit) const
{
  const auto say = [](const std::string& of, const std::vector<RecordingFinding>& findings)
  {
    for (const RecordingFinding& finding : findings)
    {
      if (finding.stops && finding.kind != "stamps")
      {
        std::cerr << "joint_twin: " << of << finding.text << '\n';
      }
    }
  };
  say("", fit.ofArm());
  for (std::size_t i = 0; i < arm_.joints.size(); ++i)
  {
    say(arm_.joints[i].short_name + ": ", fit.ofJoint(i));
  }
}
MotionFindings ArmRecording::read(const std::function<void(const std::vector<ArmJointRow>&)>& visit) const
{
  RecordingFit fit(parameters_);
  const MotionFindings findings = read(visit, fit);
  warnOf(fit);
  return findings;
}

MotionFindings ArmRecording::read(const std::function<void(const std::vector<ArmJointRow>&)>& visit,
                                  RecordingFit& fit) const
{
  std::vector<std::string> names;
  for (const ArmJoint& joint : arm_.joints)
  {
    names.push_back(joint.name);
  }
  ArmLoad load(arm_);
  std::vector<ArmJointRow> rows(names.size());
  std::vector<MotionRow> in_current;
  MotionFindings findings;
  findings.has_load = has_load_;
  const InterruptScope interrupts;
  Progress progress("reading");
  const auto forward = [&](bool at_end)
  {
    while (const ArmSample* sample = load.pop(at_end))
    {
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
        rows[i].row = sample->joints[i];
        rows[i].recorded_load = sample->joints[i].load;
        rows[i].motor_part = inertias_in_load_[i] * sample->joints[i].acceleration;
        if (!uses_recorded_)
        {
          rows[i].row.load = sample->torques[i];
        }
      }
      fit.update(sample->joints, sample->torques);
      findings.gaps += sample->joints.front().after_gap ? 1 : 0;
      visit(rows);
    }
  };
  static_cast<MotionCount&>(findings) = readArmMotion(
      source_, names,
      [&](const std::vector<MotionRow>& motion)
      {
        in_current = motion;
        for (std::size_t i = 0; i < motion.size(); ++i)
        {
          in_current[i].current *= currentPerEffort(parameters_[i]);
        }
        findings.refused += load.push(in_current) ? 0 : 1;
        forward(false);
        return interruptSignal() == 0;
      },
      [&](double done) { progress.update(done); });
  forward(true);
  findings.velocity_ratio = fit.stampFactor().value;
  return findings;
}
}  // namespace hjt
