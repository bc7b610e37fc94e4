// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_recording.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "arm/arm_configuration.hpp"
#include "base/number_text.hpp"
#include "elements/load.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/controller_table.hpp"
#include "tracking/motion_driven.hpp"
#include "tracking/telemetry_fit.hpp"

namespace hjt
{
namespace
{
/// Parameters of a joint of an arm. `gain`: torque per current that the recording states [N.m/A], or NaN. An identified
/// or configured gain takes precedence over `gain`.
Parameters parametersOf(const ArmJoint& joint, double gain, const RecordingOptions& options)
{
  ParameterMap map = armJointParameters(joint, configDirectory(options), options.identified);
  if (std::isfinite(gain) && options.identified.empty())
  {
    readAssignment("telemetry.torque_per_current=" + numberText(gain), map);
  }
  readAssignment("telemetry.load=" + options.load, map);
  addOverlays(options, map);
  Parameters parameters = parseParameters(map);
  addFaults(options, parameters);
  const LoadSource load = parameters.telemetry.load;
  if (load != LoadSource::TARGET_MOMENT && load != LoadSource::ARM)
  {
    throw ParameterError("telemetry.load: for an arm, choose the load with --load");
  }
  return parameters;
}

ArmDescription armOf(const std::string& short_name)
{
  ArmDescription arm;
  ArmJoint& joint = arm.joints.emplace_back();
  const std::optional<UrJoint> known = findUrJoint(short_name);
  joint.name = known ? known->name : short_name;
  joint.short_name = short_name;
  return arm;
}

/// Text for the user if stamps and angles contradict the recorded velocities, else an empty text.
std::string wrongStamps(const MotionCount& count)
{
  constexpr double TOLERANCE = 0.03;
  if (!std::isfinite(count.velocity_ratio) || std::abs(count.velocity_ratio - 1.0) <= TOLERANCE)
  {
    return {};
  }
  const std::string factor = roundedText(count.velocity_ratio, 3);
  return "according to the stamps, the angles change " + factor +
         " times as fast as the recorded velocities say; wrong stamps make all results wrong" +
         (count.velocity_ratio > 0.0 ? "; --time-scale " + factor + " makes stamps and velocities agree" : "");
}
}  // namespace

ArmRecording::ArmRecording(const RecordingOptions& options)
  : options_(options)
  , is_arm_(!options.arm.empty())
  , arm_(is_arm_ ? readArmDescription(findArm(options.arm, configDirectory(options))) : armOf(options.joint))
{
  if (!is_arm_)
  {
    parameters_.push_back(loadParameters(options));  // errors of parameters are reported before those of the file
  }
  source_ = motionSource(options);
  if (isFile() && !options.stated)
  {
    options_.stated = std::make_shared<const RecordedStatements>(readStatements(source_, is_arm_));
  }
  stated_gains_.assign(arm_.joints.size(), std::numeric_limits<double>::quiet_NaN());
  const RecordedStatements stated = options_.stated ? *options_.stated : RecordedStatements();
  if (stated.gains.size() == arm_.joints.size())
  {
    stated_gains_ = stated.gains;
  }
  if (stated.payload && stated.payload->mass > 0.0 && arm_.payload.mass == 0.0)
  {
    arm_.payload = *stated.payload;
    payload_text_ = "payload of " + roundedText(arm_.payload.mass, 3) + " kg, as the controller states";
  }
  for (std::size_t i = parameters_.size(); i < arm_.joints.size(); ++i)
  {
    parameters_.push_back(parametersOf(arm_.joints[i], stated_gains_[i], options));
  }
  has_load_ = isFile() ? stated.has_load : options.rows_have_load;
  uses_recorded_ = is_arm_ ? options.load == LOAD_RECORDED : has_load_;
  if (uses_recorded_ && !has_load_)
  {
    throw InputError(source_.path + " holds no load of the joints; with --load arm the program computes the load");
  }
  for (Parameters& parameters : parameters_)
  {
    Parameters drive = parameters;
    inertias_in_load_.push_back(is_arm_ ? takeInertiaInLoad(drive) : 0.0);
    if (!uses_recorded_)
    {
      parameters = drive;
    }
    source_.speeds.push_back(greatestSpeed(parameters));
  }
}

MotionSource ArmRecording::source(std::size_t joint) const
{
  const Parameters& parameters = parameters_[joint];
  MotionSource source = source_;
  source.joint = is_arm_ ? options_.affixes(arm_.joints[joint].name) : source_.joint;
  source.csv_joint = is_arm_ ? static_cast<int>(joint) : source_.csv_joint;
  source.speeds = { source_.speeds[joint] };
  source.current_per_effort = currentPerEffort(parameters);
  source.current_per_motor_torque = nominalRatio(parameters.gear) / parameters.telemetry.torque_per_current;
  return source;
}

std::string ArmRecording::twinNamespace(std::size_t joint) const
{
  return (is_arm_ ? "/" + arm_.joints[joint].short_name : std::string()) + options_.joint_namespace;
}

MotionFindings ArmRecording::read(const VisitRows& visit, RecordingFit& fit) const
{
  return is_arm_ ? readArm(visit, fit) : readJoint(visit);
}

MotionFindings ArmRecording::readSamples(const VisitSample& visit, RecordingFit& fit) const
{
  if (is_arm_)
  {
    const auto visit_all = [&](const std::vector<ArmJointRow>& rows)
    {
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
        visit(i, rows[i].row);
      }
    };
    return readArm(visit_all, fit);
  }
  MotionDifferentiator differentiator;
  const Load load(parameters_.front().output);
  const auto forward = [&](bool at_end)
  {
    while (std::optional<MotionSample> sample = differentiator.pop(at_end))
    {
      sample->load = has_load_ ? sample->load : ownTorque(load, *sample);
      visit(0, *sample);
    }
  };
  MotionFindings found = readJoint(
      [&](const std::vector<ArmJointRow>& rows)
      {
        differentiator.push(rows.front().row);
        forward(false);
      });
  forward(true);
  found.refused = differentiator.refused();
  found.gaps = differentiator.gaps();
  if (found.corrupt > 0 || found.refused > 0 || found.gaps > 0)
  {
    options_.watch.notice(source_.path + ": " + std::to_string(found.corrupt) + " messages unreadable or impossible, " +
                          std::to_string(found.refused) + " rows repeated or out of order, " +
                          std::to_string(found.gaps) + " gaps over " + roundedText(MotionDifferentiator::MAX_GAP, 3) +
                          " s");
  }
  return found;
}

MotionCount ArmRecording::readRows(const VisitMotionRows& visit) const
{
  std::vector<std::string> names;
  for (const ArmJoint& joint : arm_.joints)
  {
    names.push_back(is_arm_ ? options_.affixes(joint.name) : source_.joint);
  }
  return readMotion(
      is_arm_ ? source_ : source(0), names,
      [&](const std::vector<MotionRow>& rows) { return visit(rows) && !options_.watch.stopped(); },
      options_.watch.progress("reading"));
}

MotionFindings ArmRecording::readJoint(const VisitRows& visit) const
{
  RatioFit ratio(nominalRatio(parameters_.front().gear));
  std::vector<ArmJointRow> rows(1);
  MotionFindings found;
  found.has_load = has_load_;
  const auto take = [&](const std::vector<MotionRow>& motion)
  {
    const MotionRow& row = motion.front();
    rows.front() = { { row }, row.load, 0.0 };
    ratio.add(row);
    visit(rows);
    return true;
  };
  static_cast<MotionCount&>(found) = readRows(take);
  if (!found.misfit.exists())
  {
    found.misfit = { Reason::GEAR_RATIO, ratio.text() };
  }
  return found;
}

MotionFindings ArmRecording::readArm(const VisitRows& visit, RecordingFit& fit) const
{
  ArmLoad load(arm_, course_);
  std::vector<ArmJointRow> rows(arm_.joints.size());
  std::vector<MotionRow> in_current;
  MotionFindings findings;
  findings.has_load = has_load_;
  const auto forward = [&](bool at_end)
  {
    while (const ArmSample* sample = load.pop(at_end))
    {
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
        rows[i].row = sample->own[i];
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
  const auto take = [&](const std::vector<MotionRow>& motion)
  {
    in_current = motion;
    for (std::size_t i = 0; i < motion.size() && isFile(); ++i)
    {
      in_current[i].current *= currentPerEffort(parameters_[i]);
    }
    findings.refused += load.push(in_current) ? 0 : 1;
    forward(false);
    return true;
  };
  static_cast<MotionCount&>(findings) = readRows(take);
  findings.remark(payload_text_);
  forward(true);
  findings.velocity_ratio = fit.stampFactor().value;
  fit.refuse(findings.misfit);
  return findings;
}

void ArmRecording::noticeOf(const RecordingFit& fit) const
{
  const auto say = [this](const std::string& of, const std::vector<RecordingFinding>& findings)
  {
    for (const RecordingFinding& finding : findings)
    {
      if (finding.stops && finding.kind != "stamps")
      {
        options_.watch.notice(of + finding.text);
      }
    }
  };
  if (is_arm_)
  {
    say("", fit.ofArm());
    for (std::size_t i = 0; i < arm_.joints.size(); ++i)
    {
      say(arm_.joints[i].short_name + ": ", fit.ofJoint(i));
    }
  }
}

void ArmRecording::noticeOf(const MotionFindings& found) const
{
  if (const std::string text = wrongStamps(found); !text.empty())
  {
    options_.watch.notice(text);
  }
  for (const std::string& remark : found.remarks)
  {
    options_.watch.notice(source_.path + ": " + remark);
  }
  if (!is_arm_ && found.misfit.exists())  // of an arm, RecordingFit finds the misfit
  {
    options_.watch.notice(source_.path + ": " + found.misfit.clause);
  }
}
}  // namespace hjt
