// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/motion_options.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/report.hpp"
#include "apps/common/text_table.hpp"

#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "identification/cross_validation.hpp"

namespace hjt
{
namespace
{
constexpr double PAST_THE_END = 1.0;  // [s]

struct IdentifyOptions : MotionOptions
{
  std::string out;
  std::vector<double> train;
  std::vector<double> judge;
  int folds{};
};

/// The identified parameters as an overlay: section by section, each with its interval.
void writeOverlay(const IdentifyOptions& options, const Identification& found)
{
  std::map<std::string, std::string> sections;
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
  std::string text =
      "# Overlay: results of `joint_twin identify` for joint  " + options.joint + " in\n# " + options.recording + "\n";
  for (const auto& [section, entries] : sections)
  {
    text += "\n" + section + ":\n" + entries;
  }
  writeTextFile(options.out, text);
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
                                 { "ripple_lag", "", telemetry.ripple_lag } };
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
    writeOverlay(options, report.found);
  }
  return EXIT_DONE;
}

void declare(Command& command, IdentifyOptions& options)
{
  addMotionOptions(command, options);
  command.add("--out", options.out, "the overlay").type("FILE.yaml");
  command.add("--train", options.train, "from,to: part to identify on; default: the first third [s]").pair();
  command.add("--judge", options.judge, "from,to: part to test on; default: the rest [s]").pair();
  command
      .add("--folds", options.folds,
           "cuts the part to identify on into this many pieces and predicts each from the others")
      .range(2, 100);
}

const Subcommand IDENTIFY{
  Subject::RECORDING, "identify",
  "gain, friction, inertia and ripple of a joint from its recorded motion and current, as an overlay", declare,
  identifyJoint
};
}  // namespace
}  // namespace hjt
