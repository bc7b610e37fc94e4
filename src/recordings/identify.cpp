// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/identify.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/report.hpp"
#include "recordings/arm_recording.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
// Time from the last row to the end of a part that reaches to the end of the recording [s].
constexpr double PAST_THE_END = 1.0;

/// Text of the entries of an overlay, by the name of their section.
using Sections = std::map<std::string, std::string>;

/// Overlay entries of the identified parameters. Comments in the overlay state the intervals.
Sections identifiedSections(const Identification& found)
{
  Sections sections;
  const auto add = [&](const std::string& key, const std::string& value, const std::string& comment)
  {
    const std::size_t dot = key.find('.');
    sections[key.substr(0, dot)] += "  # " + comment + "\n  " + key.substr(dot + 1) + ": " + value + "\n";
  };
  for (const IdentifiedValue& value : found.values)
  {
    if (!value.refusal.empty() || value.key.empty())
    {
      continue;
    }
    add(value.key, numberText(value.value),
        value.name + " [" + value.unit + "]; 95 %: +-" + shortNumber(value.half_width) + ". Identified.");
    if (value.key == "mesh.friction_kinetic")
    {
      add("mesh.friction_static", numberText(found.parameters.mesh.friction_static),
          "In proportion to mesh.friction_kinetic.");
    }
  }
  const TelemetryParameters& telemetry = found.parameters.telemetry;
  for (const RippleLine& line : found.lines)
  {
    add(line.key, "[" + numberText(line.torque[0]) + ", " + numberText(line.torque[1]) + "]",
        "Ripple, " + shortNumber(line.order) + " cycles per joint turn [N.m]" +
            (line.refusal.empty() ? "; 95 %: +-" + shortNumber(line.half_width) + ". Identified." :
                                    ": " + line.refusal + "."));
  }
  add("telemetry.ripple_resonance", numberText(telemetry.ripple_resonance), "Resonance of the load [Hz].");
  add("telemetry.ripple_damping", numberText(telemetry.ripple_damping), "Damping ratio of the resonance [-].");
  add("telemetry.ripple_lag", numberText(telemetry.ripple_lag), "Lag of the ripple behind the angle [s].");
  add("telemetry.ripple_fastest", numberText(telemetry.ripple_fastest),
      "Speed above which no ripple is known [rad/s].");
  return sections;
}

void writeOverlay(const IdentifyOptions& options, const std::string& joint, const std::string& path,
                  const Sections& sections)
{
  std::string text =
      "# Overlay: results of `joint_twin identify` for joint  " + joint + " in\n# " + options.recording + "\n";
  for (const auto& [section, entries] : sections)
  {
    text += "\n" + section + ":\n" + entries;
  }
  writeTextFile(path, text);
}

/// Whether the interval of at least one identified value or ripple line excludes zero.
bool saysSomething(const Identification& found)
{
  return std::any_of(found.values.begin(), found.values.end(),
                     [](const IdentifiedValue& value)
                     { return value.refusal.empty() && value.half_width < std::abs(value.value); }) ||
         std::any_of(found.lines.begin(), found.lines.end(),
                     [](const RippleLine& line) { return line.refusal.empty() && line.half_width < line.amplitude; });
}

/// Warns the user if nothing was identified, or if the identified parameters are worse than the configured ones.
void noticeOf(const IdentifiedJoint& joint, bool any, const Watch& watch)
{
  const JudgedErrors& judged = joint.found.judged;
  if (any && judged.identified.all > judged.configured.all)
  {
    watch.notice("in the part for judging, the identified parameters predict the current worse (" +
                 shortNumber(judged.identified.all) + " A) than the configured ones (" +
                 shortNumber(judged.configured.all) + " A); identify from a longer part with --train");
  }
  if (!any)
  {
    watch.notice("nothing could be identified from " + shortNumber(joint.train.from) + " to " +
                 shortNumber(joint.train.to) + " s of the recording");
  }
}

/// Warns the user if the simple fit (gain, Coulomb and viscous friction) predicts the current better than the twin.
void noticeOfSimpleFit(const IdentifiedJoint& joint, const Watch& watch)
{
  const double twin = joint.left_out.identified.moving;
  const double simple = joint.left_out.gain_coulomb_viscous.moving;
  if (joint.refusal.empty() && twin > simple)
  {
    watch.notice(joint.name +
                 ": in moving rows that a fit did not use, the simple fit of gain, Coulomb and viscous friction "
                 "predicts the current better (" +
                 roundedText(simple, 3) + " A) than the identified parameters (" + roundedText(twin, 3) + " A)");
  }
}

constexpr int ARM_FOLDS = 5;
/// The ripple of an arm's joint is kept up to this ratio [-]: error of the current with ripple over the error without
/// ripple, in moving rows of the pieces that the fit did not use.
constexpr double RIPPLE_GAIN = 0.95;

/// @throws InputError if the options name a part to judge for an arm, or a part that ends before its begin.
void requireParts(const IdentifyOptions& options)
{
  if (!options.arm.empty() && options.judge)
  {
    throw InputError("judge: only for a single joint; an arm is judged by pieces that the fit did not use (folds)");
  }
  for (const std::optional<Span>& part : { options.train, options.judge })
  {
    if (part && !(part->from < part->to))
    {
      throw InputError("a part from " + shortNumber(part->from) + " to " + shortNumber(part->to) +
                       " s ends before it begins");
    }
  }
}

/// Sets the parts of the recording for identifying and for judging, from the options or by default.
void chooseParts(const IdentifyOptions& options, double duration, double last, IdentifiedJoint& joint)
{
  const bool is_arm = !options.arm.empty();
  const double third = duration / 3.0;
  const Span whole{ 0.0, last + PAST_THE_END };
  joint.train = options.train.value_or(is_arm ? whole : Span{ 0.0, third });
  joint.judge = options.judge.value_or(is_arm ? whole : Span{ third, duration + PAST_THE_END });
}

/// Number of pieces, each of which is predicted by a fit to the other pieces. Default for an arm: ARM_FOLDS.
int foldsOf(const IdentifyOptions& options)
{
  return options.folds > 0 || options.arm.empty() ? options.folds : ARM_FOLDS;
}

/// Identifies a joint from its part of the recording, and then from that part without each of its pieces. `fitted` is
/// called after each fit. @throws InputError if the joint hardly moves.
void identifyJoint(const IdentifyOptions& options, const Parameters& parameters, bool load_recorded,
                   const std::vector<MotionSample>& samples, const std::function<void()>& fitted,
                   IdentifiedJoint& joint)
{
  const auto look = [&]
  {
    if (options.watch.stopped())
    {
      throw Stopped{};
    }
  };
  const JudgedPart judge{ samplesWithin(samples, { -HUGE_VAL, joint.judge.to }), joint.judge.from };
  joint.found = identify(parameters, samplesWithin(samples, joint.train), judge, load_recorded, look);
  fitted();
  const bool is_arm = !options.arm.empty();
  JudgedErrors& left_out = joint.left_out;
  left_out = leaveOneOut(parameters, samples, joint.train, foldsOf(options), load_recorded, fitted, look);
  if (is_arm && left_out.identified.moving > RIPPLE_GAIN * left_out.without_ripple.moving)
  {
    left_out.identified = left_out.without_ripple;
    for (RippleLine& line : joint.found.lines)
    {
      line.torque = {};
      line.refusal = "this ripple does not improve the prediction of pieces that the fit did not use";
    }
  }
  if (is_arm && left_out.identified.all > left_out.configured.all)
  {
    joint.refusal = "on pieces that the fit did not use, the identified parameters are worse than the configured ones";
  }
}

/// Payload that the difference between measured and predicted currents shows. The prediction is that of the configured
/// twins. The result has no meaning if the user stopped the program.
IdentifiedPayload payloadOf(const ArmRecording& recording, const std::vector<std::vector<MotionSample>>& samples,
                            const Watch& watch)
{
  LoadFit fit(recording.arm(), recording.parameters());
  std::vector<MotionDriven> twins(recording.parameters().begin(), recording.parameters().end());
  std::vector<MotionSample> row(samples.size());
  for (std::size_t k = 0; k < samples.front().size(); ++k)
  {
    if (watch.stopped())
    {
      return {};
    }
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      row[i] = samples[i][k];
      twins[i].step(row[i]);
    }
    fit.add(row, [&](std::size_t i) -> const MotionDriven& { return twins[i]; });
  }
  return fit.solve(std::vector<bool>(samples.size(), true)).payload;
}

/// Path of a joint's overlay. @throws InputError if the file exists and must not be overwritten.
std::string overlayOf(const IdentifyOptions& options, const std::string& joint)
{
  const std::string path =
      options.arm.empty() ? options.out : (std::filesystem::path(options.out) / (joint + ".yaml")).string();
  requireWritable(path, options.force, options.recording);
  return path;
}

void writeOverlay(const IdentifyOptions& options, const ArmJoint& arm_joint, const IdentifiedJoint& joint)
{
  Sections sections = joint.refusal.empty() ? identifiedSections(joint.found) : Sections();
  if (!options.arm.empty())
  {
    sections["joint"] = "  # Name of the joint in JointState messages.\n  name: " + arm_joint.name + "\n";
  }
  writeOverlay(options, arm_joint.short_name, overlayOf(options, arm_joint.short_name), sections);
}

std::vector<IdentifiedJoint> identifyJoints(const IdentifyOptions& options, const ArmRecording& recording,
                                            double duration, const std::vector<std::vector<MotionSample>>& samples)
{
  std::vector<IdentifiedJoint> joints;
  const auto progress = options.watch.progress("identifying");
  const std::size_t fits =
      1 + static_cast<std::size_t>(foldsOf(options));  // number of fits of a joint; each fit takes the same time
  for (std::size_t i = 0; i < samples.size() && !options.watch.stopped(); ++i)
  {
    IdentifiedJoint& joint = joints.emplace_back();
    joint.name = recording.joints()[i].short_name;
    std::size_t done = i * fits;
    const auto fitted = [&] { progress(static_cast<double>(++done) / static_cast<double>(fits * samples.size())); };
    try
    {
      chooseParts(options, duration, samples[i].empty() ? 0.0 : samples[i].back().time, joint);
      identifyJoint(options, recording.parameters(i), recording.usesRecordedLoad(), samples[i], fitted, joint);
    }
    catch (const InputError& error)
    {
      if (!recording.isArm())
      {
        throw;
      }
      joint.found = {};
      joint.refusal = error.what();
    }
    catch (const Stopped&)
    {
      break;
    }
  }
  return joints;
}

Option& addSpan(OptionTable& table, const char* name, std::optional<Span>& span, const std::string& help)
{
  const auto take = [&span](const std::string& text)
  {
    const double time = decimalNumber(text).value();
    span = { span ? span->to : time, time };
  };
  return table.add(name, Option::Kind::NUMBER, take, help).pair();
}

const std::vector<Column<IdentifiedValue>> VALUE_COLUMNS{
  { "name", &IdentifiedValue::name },      { "key", &IdentifiedValue::key },
  { "unit", &IdentifiedValue::unit },      { "configured", &IdentifiedValue::configured },
  { "value", &IdentifiedValue::value },    { "half_width", &IdentifiedValue::half_width },
  { "refusal", &IdentifiedValue::refusal }
};
const std::vector<Column<RippleLine>> LINE_COLUMNS{ { "key", &RippleLine::key },
                                                    { "order", &RippleLine::order },
                                                    { "amplitude", &RippleLine::amplitude },
                                                    { "half_width", &RippleLine::half_width },
                                                    { "phase", &RippleLine::phase },
                                                    { "refusal", &RippleLine::refusal } };

void addErrors(const std::string& key, const JudgedErrors& judged, bool shown, std::vector<ReportLine>& lines)
{
  const auto add = [&](const std::string& name, const std::string& label, const CurrentError& error)
  {
    const std::string path = key + "." + name;
    lines.insert(lines.end(), { { path + ".rows", "", error.rows },
                                { path + ".all", "", error.all },
                                { path + ".moving", "", error.moving },
                                { path + ".resting", "", error.resting },
                                { path + ".signal", "", error.signal } });
    if (shown)
    {
      lines.push_back({ "", label,
                        shortNumber(error.all) + " (moving " + shortNumber(error.moving) + ", resting " +
                            shortNumber(error.resting) + ")",
                        "A" });
    }
  };
  add("configured", "as configured", judged.configured);
  add("without_ripple", "identified, without ripple", judged.without_ripple);
  add("identified", "identified", judged.identified);
  add("gain_coulomb_viscous", "simple fit of gain, Coulomb and viscous friction", judged.gain_coulomb_viscous);
}

Report valuesOf(const IdentifiedJoint& joint, std::vector<std::string>& refused)
{
  const Identification& found = joint.found;
  const TelemetryParameters& telemetry = found.parameters.telemetry;
  std::vector<ReportLine> lines{ { "train", "", std::vector<double>{ joint.train.from, joint.train.to } },
                                 { "judge", "", std::vector<double>{ joint.judge.from, joint.judge.to } },
                                 { "values", "", Table(VALUE_COLUMNS, found.values).rows() },
                                 { "lines", "", Table(LINE_COLUMNS, found.lines).rows() },
                                 { "ripple_resonance", "", telemetry.ripple_resonance },
                                 { "ripple_damping", "", telemetry.ripple_damping },
                                 { "ripple_lag", "", telemetry.ripple_lag },
                                 { "ripple_fastest", "", telemetry.ripple_fastest } };
  const auto tell = [&](const std::string& name, const auto& value, double size, const std::string& unit)
  {
    if (value.refusal.empty())
    {
      lines.push_back({ "", name, shortNumber(size) + " +- " + shortNumber(value.half_width), unit });
    }
    else
    {
      refused.push_back(name + ": " + value.refusal);
    }
  };
  for (const IdentifiedValue& value : found.values)
  {
    tell(value.name, value, value.value, value.unit);
  }
  for (const RippleLine& line : found.lines)
  {
    tell("ripple, " + shortNumber(line.order) + " a turn", line, line.amplitude, "N.m");
  }
  const auto span = [&](const std::string& name, const Span& part) {
    lines.push_back({ "", name, shortNumber(part.from) + " to " + shortNumber(part.to), "s" });
  };
  span("identified on", joint.train);
  span("judged on", joint.judge);
  return { lines, {} };
}

std::vector<ReportLine> errorsOf(const IdentifiedJoint& joint)
{
  std::vector<ReportLine> errors{ { "", "the current itself, rms", joint.found.judged.identified.signal, "A" },
                                  { "", "error of the current in the part for judging, rms", "" } };
  addErrors("judged", joint.found.judged, true, errors);
  const bool folded = joint.left_out.identified.rows > 0;
  if (folded)
  {
    errors.push_back({ "", "on pieces that the fit did not use", "" });
  }
  addErrors("left_out", joint.left_out, folded, errors);
  return errors;
}

std::vector<ReportLine> linesOf(const IdentifiedPayload& found)
{
  const auto list = [](const std::array<double, 3>& values)
  { return std::vector<double>(values.begin(), values.end()); };
  constexpr double KNOWN = 5.0;  // largest half width of a payload's mass that counts as known [kg]
  const std::string mass = found.mass_half_width < KNOWN ?
                               shortNumber(found.mass) + " +- " + shortNumber(found.mass_half_width) + " kg" :
                               "not known: the arm hardly moves, or takes too few poses";
  std::vector<ReportLine> lines{ { "payload.configured", "", found.configured.mass },
                                 { "payload.mass", "", found.mass },
                                 { "payload.mass_half_width", "", found.mass_half_width },
                                 { "payload.moment", "", list(found.moment) },
                                 { "payload.moment_half_width", "", list(found.moment_half_width) },
                                 { "", "payload from the currents", mass },
                                 { "", "payload configured", found.configured.mass, "kg" } };
  if (found.differs() && found.isCarried())
  {
    std::string centre;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      centre += (axis > 0 ? ", " : "") + shortNumber(found.moment[axis] / found.mass) + " +- " +
                shortNumber(found.moment_half_width[axis] / found.mass);
    }
    lines.push_back({ "", "centre of this payload in the frame of the tip", centre, "m" });
    lines.push_back({ "", "if the arm carries this payload", "set it in the arm's file and identify again" });
  }
  return lines;
}

const std::vector<Column<IdentifiedJoint>> JOINT_TABLE{
  { "joint", &IdentifiedJoint::name, "joint" },
  { "signal", [](const IdentifiedJoint& joint) { return joint.left_out.identified.signal; }, "current, rms [A]" },
  { "configured", [](const IdentifiedJoint& joint) { return joint.left_out.configured.all; }, "as configured [A]" },
  { "identified", [](const IdentifiedJoint& joint) { return joint.left_out.identified.all; }, "identified [A]" },
  { "identified_moving", [](const IdentifiedJoint& joint) { return joint.left_out.identified.moving; }, "moving [A]" },
  { "gain_coulomb_viscous", [](const IdentifiedJoint& joint) { return joint.left_out.gain_coulomb_viscous.all; },
    "gain, Coulomb, viscous [A]" },
  { "values", [](const IdentifiedJoint& joint)
    { return joint.found.values.empty() ? Json() : Table(VALUE_COLUMNS, joint.found.values).rows(); } },
  { "refusal", &IdentifiedJoint::refusal, "stays as configured" }
};
}  // namespace

void addOptions(OptionTable& table, IdentifyOptions& options)
{
  addRecordingOption(table, options);
  addJointOptions(table, options);
  table.add("--out", options.out, "file for the overlay; for an arm, a directory of overlays").type("FILE.yaml|DIR");
  addSpan(table, "--train", options.train,
          "from,to: part to identify from [s]; default: the first third; for an arm, the whole recording");
  addSpan(table, "--judge", options.judge,
          "from,to: part to test on [s]; default: the last two thirds; not for an arm");
  table
      .add(
          "--folds", options.folds,
          "number of pieces of the part to identify from; a fit to the others predicts each piece; default for an arm: "
          "5")
      .range(2, 100);
}

Identified identify(const IdentifyOptions& options)
{
  requireParts(options);
  const ArmRecording recording(options);
  if (!options.out.empty())
  {
    if (recording.isArm())
    {
      std::filesystem::create_directories(options.out);
    }
    for (const ArmJoint& joint : recording.joints())
    {
      overlayOf(options, joint.short_name);
    }
  }
  std::vector<std::vector<MotionSample>> samples(recording.joints().size());
  Identified identified{ recording.isArm(), options.load, {}, {}, {}, false };
  RecordingFit fit(recording.parameters());
  identified.found =
      recording.readSamples([&](std::size_t i, const MotionSample& sample) { samples[i].push_back(sample); }, fit);
  recording.noticeOf(fit);
  recording.noticeOf(identified.found);
  identified.joints = identifyJoints(options, recording, identified.found.duration, samples);
  if (recording.isArm() && !options.watch.stopped())
  {
    identified.payload = payloadOf(recording, samples, options.watch);
  }
  if (options.watch.stopped())
  {
    return identified;
  }
  if (recording.isArm())
  {
    for (const IdentifiedJoint& joint : identified.joints)
    {
      noticeOfSimpleFit(joint, options.watch);
    }
    identified.any = std::any_of(identified.joints.begin(), identified.joints.end(),
                                 [](const IdentifiedJoint& joint) { return joint.refusal.empty(); });
  }
  else
  {
    identified.any = saysSomething(identified.joints.front().found);
    if (!recording.hasRecordedLoad())
    {
      options.watch.notice(
          "the recording holds no load of the joint; the program uses the configured weight and inertia, and "
          "their error hides the friction");
    }
    noticeOf(identified.joints.front(), identified.any, options.watch);
  }
  for (std::size_t i = 0; i < samples.size() && !options.out.empty() && (identified.any || recording.isArm()); ++i)
  {
    writeOverlay(options, recording.joints()[i], identified.joints[i]);
  }
  return identified;
}

IdentifyReport reportOf(const Identified& identified)
{
  IdentifyReport report;
  if (!identified.is_arm)
  {
    report.values = valuesOf(identified.joints.front(), report.refused);
    report.errors = errorsOf(identified.joints.front());
    return report;
  }
  report.values.lines = { { "rows", "rows", identified.found.rows }, { "load", "load", identified.load } };
  const std::vector<ReportLine> payload = linesOf(*identified.payload);
  report.values.lines.insert(report.values.lines.end(), payload.begin(), payload.end());
  report.values.tables = { { "joints", Table(JOINT_TABLE, identified.joints) } };
  return report;
}

Report IdentifyReport::whole() const
{
  Report report = values;
  report.lines.insert(report.lines.end(), errors.begin(), errors.end());
  return report;
}
}  // namespace hjt
