// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "apps/common/arm_recording.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/text_table.hpp"

#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "identification/cross_validation.hpp"
#include "identification/payload_fit.hpp"

namespace hjt
{
namespace
{
constexpr double PAST_THE_END = 1.0;  // [s]

struct IdentifyOptions : ArmOptions
{
  std::string out;
  std::vector<double> train;
  std::vector<double> judge;
  int folds{};
};

/// Entries of an overlay by section.
using Sections = std::map<std::string, std::string>;

/// The identified parameters, each with its interval.
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
      add("mesh.friction_static", numberText(found.parameters.mesh.friction_static), "In proportion.");
    }
  }
  const TelemetryParameters& telemetry = found.parameters.telemetry;
  for (const RippleLine& line : found.lines)
  {
    add(line.key, "[" + numberText(line.torque[0]) + ", " + numberText(line.torque[1]) + "]",
        line.refusal.empty() ? "Ripple, " + shortNumber(line.order) + " a joint turn [N.m]; 95 %: +-" +
                                   shortNumber(line.half_width) + ". Identified." :
                               "Ripple, " + shortNumber(line.order) + " a joint turn [N.m]: " + line.refusal + ".");
  }
  add("telemetry.ripple_resonance", numberText(telemetry.ripple_resonance), "Resonance of the load [Hz].");
  add("telemetry.ripple_damping", numberText(telemetry.ripple_damping), "Its damping ratio [-].");
  add("telemetry.ripple_lag", numberText(telemetry.ripple_lag), "Of the ripple behind the angle [s].");
  add("telemetry.ripple_fastest", numberText(telemetry.ripple_fastest), "Beyond, none is known [rad/s].");
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

/// What was identified on, judged on, and what came out.
struct IdentifyReport
{
  Span train;
  Span judge;
  Identification found;
  JudgedErrors left_out;  // empty without folds
};

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
  add("gain_coulomb_viscous", "gain, Coulomb and viscous fitted alike", judged.gain_coulomb_viscous);
}

void print(const IdentifyReport& report, bool json)
{
  const Identification& found = report.found;
  const TelemetryParameters& telemetry = found.parameters.telemetry;
  std::vector<ReportLine> lines{ { "train", "", std::vector<double>{ report.train.from, report.train.to } },
                                 { "judge", "", std::vector<double>{ report.judge.from, report.judge.to } },
                                 { "values", "", Table(VALUE_COLUMNS, found.values).rows() },
                                 { "lines", "", Table(LINE_COLUMNS, found.lines).rows() },
                                 { "ripple_resonance", "", telemetry.ripple_resonance },
                                 { "ripple_damping", "", telemetry.ripple_damping },
                                 { "ripple_lag", "", telemetry.ripple_lag },
                                 { "ripple_fastest", "", telemetry.ripple_fastest } };
  std::vector<std::string> refused;
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
  span("identified on", report.train);
  span("judged on", report.judge);
  // A block of its own: its values are long, the names above are.
  std::vector<ReportLine> errors{ { "", "the current itself, rms", found.judged.identified.signal, "A" },
                                  { "", "error of the current on the judged part, rms", "" } };
  addErrors("judged", found.judged, true, errors);
  const bool folded = report.left_out.identified.rows > 0;
  if (folded)
  {
    errors.push_back({ "", "on pieces left out in turn", "" });
  }
  addErrors("left_out", report.left_out, folded, errors);
  if (json)
  {
    lines.insert(lines.end(), errors.begin(), errors.end());
    printReport(true, lines);
    return;
  }
  printReport(false, lines);
  std::cout << '\n';
  printReport(false, errors);
  if (!refused.empty())
  {
    std::cout << "\nnot identifiable from this motion:\n";
    for (const std::string& line : refused)
    {
      printWrapped(line, 2);
    }
  }
}

/// What the user must know to judge the result; false: nothing was identified.
bool warn(const IdentifyReport& report, bool load_recorded)
{
  // An interval that holds zero says nothing.
  const Identification& found = report.found;
  const bool any =
      std::any_of(found.values.begin(), found.values.end(),
                  [](const IdentifiedValue& value)
                  { return value.refusal.empty() && value.half_width < std::abs(value.value); }) ||
      std::any_of(found.lines.begin(), found.lines.end(),
                  [](const RippleLine& line) { return line.refusal.empty() && line.half_width < line.amplitude; });
  if (!load_recorded)
  {
    std::cerr
        << "joint_twin: the recording holds no load of the joint; weight and inertia are taken as configured, and "
           "their error hides the friction\n";
  }
  if (any && found.judged.identified.all > found.judged.configured.all)
  {
    std::cerr << "joint_twin: on the judged part the identified parameters predict the current worse ("
              << shortNumber(found.judged.identified.all) << " A) than the configured ones ("
              << shortNumber(found.judged.configured.all) << " A); identify on more motion with --train\n";
  }
  if (!any)
  {
    std::cerr << "joint_twin: nothing could be identified from " << shortNumber(report.train.from) << " to "
              << shortNumber(report.train.to) << " s of the recording\n";
  }
  return any;
}

int identifyJoint(const IdentifyOptions& options)
{
  const Parameters parameters = loadParameters(options);
  requireWritable(options.out, options.force, options.recording);
  std::vector<MotionSample> samples;
  const MotionFindings count =
      visitMotion(options, MotionDriven(parameters), [&](const MotionSample& sample) { samples.push_back(sample); });
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  const double third = count.duration / 3.0;
  const auto span = [](const std::vector<double>& given, double from, double to) {
    return given.empty() ? Span{ from, to } : Span{ given[0], given[1] };
  };
  IdentifyReport report;
  report.train = span(options.train, 0.0, third);
  report.judge = span(options.judge, third, count.duration + PAST_THE_END);
  const JudgedPart judge{ samplesWithin(samples, { -HUGE_VAL, report.judge.to }), report.judge.from };
  report.found = identify(parameters, samplesWithin(samples, report.train), judge, count.has_load);
  report.left_out = leaveOneOut(parameters, samples, report.train, options.folds, count.has_load);
  print(report, options.json);
  if (!warn(report, count.has_load))
  {
    return EXIT_FAILED;
  }
  if (!options.out.empty())
  {
    writeOverlay(options, options.joint, options.out, identifiedSections(report.found));
  }
  return EXIT_DONE;
}

constexpr int ARM_FOLDS = 5;
/// Largest error of pieces left out with ripple over that without, moving, at which the ripple is kept.
constexpr double RIPPLE_GAIN = 0.95;

/// Fits an arm's joint to all of its samples; the pieces left out in turn judge. @throws InputError if it hardly moves.
IdentifyReport identifyArmJoint(const IdentifyOptions& options, const Parameters& parameters, bool load_recorded,
                                const std::vector<MotionSample>& samples)
{
  const Span whole{ 0.0, samples.back().time + PAST_THE_END };
  const auto span = [&](const std::vector<double>& given) {
    return given.empty() ? whole : Span{ given[0], given[1] };
  };
  IdentifyReport report;
  report.train = span(options.train);
  report.judge = span(options.judge);
  const JudgedPart judge{ samplesWithin(samples, { -HUGE_VAL, report.judge.to }), report.judge.from };
  report.found = identify(parameters, samplesWithin(samples, report.train), judge, load_recorded);
  JudgedErrors& left_out = report.left_out;
  left_out =
      leaveOneOut(parameters, samples, report.train, options.folds > 0 ? options.folds : ARM_FOLDS, load_recorded);
  if (left_out.identified.moving > RIPPLE_GAIN * left_out.without_ripple.moving)
  {
    left_out.identified = left_out.without_ripple;
    for (RippleLine& line : report.found.lines)
    {
      line.torque = {};
      line.refusal = "predicts pieces left out no better";
    }
  }
  return report;
}

struct IdentifiedJoint
{
  std::string name;
  JudgedErrors left_out;
  Json found;           // the identified values
  std::string refusal;  // why the joint stays as configured; empty: it does not
};

const std::vector<Column<IdentifiedJoint>> JOINT_COLUMNS{
  { "joint", &IdentifiedJoint::name, "joint" },
  { "signal", [](const IdentifiedJoint& joint) { return joint.left_out.identified.signal; }, "current, rms [A]" },
  { "configured", [](const IdentifiedJoint& joint) { return joint.left_out.configured.all; }, "as configured [A]" },
  { "identified", [](const IdentifiedJoint& joint) { return joint.left_out.identified.all; }, "identified [A]" },
  { "identified_moving", [](const IdentifiedJoint& joint) { return joint.left_out.identified.moving; }, "moving [A]" },
  { "gain_coulomb_viscous", [](const IdentifiedJoint& joint) { return joint.left_out.gain_coulomb_viscous.all; },
    "gain, Coulomb, viscous [A]" },
  { "values", &IdentifiedJoint::found },
  { "refusal", &IdentifiedJoint::refusal, "stays as configured" }
};

/// By the currents that the twins predict as configured.
IdentifiedPayload payloadOf(const ArmRecording& recording, const std::vector<std::vector<MotionSample>>& samples)
{
  std::vector<std::vector<double>> predicted(samples.size());
  std::vector<double> gains;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    MotionDriven twin(recording.parameters(i));
    for (const MotionSample& sample : samples[i])
    {
      predicted[i].push_back(twin.step(sample).current);
    }
    gains.push_back(recording.parameters(i).telemetry.torque_per_current);
  }
  return identifyPayload(recording.arm(), samples, predicted, gains);
}

std::vector<ReportLine> linesOf(const IdentifiedPayload& found)
{
  const auto list = [](const std::array<double, 3>& values)
  { return std::vector<double>(values.begin(), values.end()); };
  std::vector<ReportLine> lines{ { "payload.configured", "", found.configured.mass },
                                 { "payload.mass", "", found.mass },
                                 { "payload.mass_half_width", "", found.mass_half_width },
                                 { "payload.moment", "", list(found.moment) },
                                 { "payload.moment_half_width", "", list(found.moment_half_width) },
                                 { "", "payload by the currents",
                                   shortNumber(found.mass) + " +- " + shortNumber(found.mass_half_width), "kg" },
                                 { "", "payload configured", found.configured.mass, "kg" } };
  if (found.differs() && found.mass > found.mass_half_width)
  {
    std::string centre;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      centre += (axis > 0 ? ", " : "") + shortNumber(found.moment[axis] / found.mass) + " +- " +
                shortNumber(found.moment_half_width[axis] / found.mass);
    }
    lines.push_back({ "", "its centre in the frame of the tip", centre, "m" });
    lines.push_back({ "", "if the arm carries it", "set payload in the arm's file, identify again" });
  }
  return lines;
}

int identifyArm(const IdentifyOptions& options)
{
  const ArmRecording recording(options);
  const std::size_t count = recording.joints().size();
  const auto path = [&](std::size_t joint)
  { return (std::filesystem::path(options.out) / (recording.joints()[joint].short_name + ".yaml")).string(); };
  if (!options.out.empty())
  {
    std::filesystem::create_directories(options.out);
    for (std::size_t i = 0; i < count; ++i)
    {
      requireWritable(path(i), options.force, options.recording);
    }
  }
  std::vector<std::vector<MotionSample>> samples(count);
  std::vector<MotionDifferentiator> differentiators(count);
  const auto take = [&](bool at_end)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      while (const std::optional<MotionSample> sample = differentiators[i].pop(at_end))
      {
        samples[i].push_back(*sample);
      }
    }
  };
  const MotionFindings found = recording.read(
      [&](const std::vector<ArmJointRow>& rows)
      {
        for (std::size_t i = 0; i < count; ++i)
        {
          differentiators[i].push(rows[i].row);
        }
        take(false);
      });
  take(true);
  warnOfStamps(found);
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }

  std::vector<IdentifiedJoint> joints;
  bool any = false;
  for (std::size_t i = 0; i < count; ++i)
  {
    const ArmJoint& arm_joint = recording.joints()[i];
    IdentifiedJoint joint{ arm_joint.short_name, {}, {}, {} };
    Sections sections;
    try
    {
      const IdentifyReport report =
          identifyArmJoint(options, recording.parameters(i), recording.usesRecordedLoad(), samples[i]);
      joint.left_out = report.left_out;
      joint.found = Table(VALUE_COLUMNS, report.found.values).rows();
      if (report.left_out.identified.all > report.left_out.configured.all)
      {
        joint.refusal = "what was identified predicts pieces left out worse";
      }
      else
      {
        sections = identifiedSections(report.found);
      }
    }
    catch (const InputError& error)
    {
      joint.refusal = error.what();
    }
    any = any || joint.refusal.empty();
    if (!options.out.empty())
    {
      sections["joint"] = "  # Name of the joint in JointState messages.\n  name: " + arm_joint.name + "\n";
      writeOverlay(options, arm_joint.short_name, path(i), sections);
    }
    joints.push_back(joint);
  }
  std::vector<ReportLine> lines{ { "rows", "rows", found.rows }, { "load", "load", options.load } };
  const std::vector<ReportLine> payload = linesOf(payloadOf(recording, samples));
  lines.insert(lines.end(), payload.begin(), payload.end());
  printReport(options.json, lines, { { "joints", Table(JOINT_COLUMNS, joints) } });
  return any ? EXIT_DONE : EXIT_FAILED;
}

int identifyRecording(const IdentifyOptions& options)
{
  return options.arm.empty() ? identifyJoint(options) : identifyArm(options);
}

void declare(Command& command, IdentifyOptions& options)
{
  addArmOptions(command, options);
  command.add("--out", options.out, "the overlay; of an arm a directory, an overlay for each joint")
      .type("FILE.yaml|DIR");
  command.add("--train", options.train, "from,to: part to identify on; default: the first third, of an arm all [s]")
      .pair();
  command.add("--judge", options.judge, "from,to: part to test on; default: the rest, of an arm all [s]").pair();
  command
      .add("--folds", options.folds,
           "cuts the part to identify on into this many pieces and predicts each from the others; of an arm 5 by "
           "default")
      .range(2, 100);
}

const Subcommand IDENTIFY{
  Subject::RECORDING, "identify",
  "gain, friction, inertia and ripple of a joint from its recorded motion and current, as an overlay", declare,
  identifyRecording
};
}  // namespace
}  // namespace hjt
