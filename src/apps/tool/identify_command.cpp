// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/motion_options.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/text_table.hpp"
#include "apps/common/validators.hpp"
#include "apps/tool/commands.hpp"

#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "identification/identification.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr double PAST_THE_END = 1.0;  // [s]

/// A stretch of the recording [s].
struct Span
{
  double from{};
  double to{};

  bool contains(double time) const { return time >= from && time < to; }
};

struct IdentifyOptions : MotionOptions
{
  std::string out;
  std::vector<double> train;
  std::vector<double> judge;
  int folds{};
};

/// Samples within `span` and not within `hole`; the first one after the hole follows a gap.
std::vector<MotionSample> part(const std::vector<MotionSample>& all, const Span& span, const Span& hole = {})
{
  std::vector<MotionSample> samples;
  bool gap = true;
  for (const MotionSample& sample : all)
  {
    if (!span.contains(sample.time) || hole.contains(sample.time))
    {
      gap = true;
      continue;
    }
    samples.push_back(sample);
    samples.back().after_gap |= gap;
    gap = false;
  }
  return samples;
}

/// Errors of several judged parts as one.
void addError(const CurrentError& part, CurrentError& sum)
{
  const auto rms = [](double a, std::size_t n, double b, std::size_t m)
  {
    return n + m > 0 ? std::sqrt((a * a * static_cast<double>(n) + b * b * static_cast<double>(m)) /
                                 static_cast<double>(n + m)) :
                       0.0;
  };
  sum.moving = rms(sum.moving, sum.moving_rows, part.moving, part.moving_rows);
  sum.resting = rms(sum.resting, sum.rows - sum.moving_rows, part.resting, part.rows - part.moving_rows);
  sum.all = rms(sum.all, sum.rows, part.all, part.rows);
  sum.signal = rms(sum.signal, sum.rows, part.signal, part.rows);
  sum.rows += part.rows;
  sum.moving_rows += part.moving_rows;
}

/// The part to identify on, cut into pieces: each is judged by what the others give.
JudgedErrors leaveOneOut(const Parameters& parameters, const std::vector<MotionSample>& all, const Span& train,
                         int folds, bool load_recorded)
{
  JudgedErrors sum;
  for (int fold = 0; fold < folds; ++fold)
  {
    const double piece = (train.to - train.from) / folds;
    const Span hole{ train.from + fold * piece, train.from + (fold + 1) * piece };
    const JudgedPart left_out{ part(all, { train.from, hole.to }), hole.from };
    const JudgedErrors judged = identify(parameters, part(all, train, hole), left_out, load_recorded).judged;
    addError(judged.configured, sum.configured);
    addError(judged.without_ripple, sum.without_ripple);
    addError(judged.identified, sum.identified);
    addError(judged.gain_coulomb_viscous, sum.gain_coulomb_viscous);
  }
  return sum;
}

/// The identified parameters as an overlay: section by section, each with its interval.
void writeOverlay(const IdentifyOptions& options, const Identification& found)
{
  struct Entry
  {
    std::string name;
    std::string text;
  };
  std::map<std::string, std::vector<Entry>> sections;
  const auto add = [&](const std::string& key, const std::string& value, const std::string& comment)
  {
    const std::size_t dot = key.find('.');
    sections[key.substr(0, dot)].push_back({ comment, key.substr(dot + 1) + ": " + value });
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
  add("telemetry.ripple_resonance", numberText(telemetry.ripple_resonance), "Of what the joint carries [Hz].");
  add("telemetry.ripple_damping", numberText(telemetry.ripple_damping), "Its damping ratio [-].");
  add("telemetry.ripple_lag", numberText(telemetry.ripple_lag), "Of the ripple behind the angle [s].");
  std::string text =
      "# Overlay: what `joint_twin identify` found for joint " + options.joint + " in\n# " + options.recording + "\n";
  for (const auto& [section, entries] : sections)
  {
    text += "\n" + section + ":\n";
    for (const Entry& entry : entries)
    {
      text += "  # " + entry.name + "\n  " + entry.text + "\n";
    }
  }
  writeTextFile(options.out, text);
}

Json errorJson(const CurrentError& error)
{
  return { { "rows", error.rows },
           { "all", error.all },
           { "moving", error.moving },
           { "resting", error.resting },
           { "signal", error.signal } };
}

Json errorsJson(const JudgedErrors& judged)
{
  return { { "configured", errorJson(judged.configured) },
           { "without_ripple", errorJson(judged.without_ripple) },
           { "identified", errorJson(judged.identified) },
           { "gain_coulomb_viscous", errorJson(judged.gain_coulomb_viscous) } };
}

/// What was identified on, judged on, and what came out.
struct Report
{
  Span train;
  Span judge;
  Identification found;
  JudgedErrors left_out;  // empty without folds
};

void printJson(const Report& report)
{
  const Identification& found = report.found;
  Json values = Json::array();
  for (const IdentifiedValue& value : found.values)
  {
    values.push_back({ { "name", value.name },
                       { "key", value.key },
                       { "unit", value.unit },
                       { "configured", value.configured },
                       { "value", value.value },
                       { "half_width", value.half_width },
                       { "refusal", value.refusal } });
  }
  Json lines = Json::array();
  for (const RippleLine& line : found.lines)
  {
    lines.push_back({ { "key", line.key },
                      { "order", line.order },
                      { "amplitude", line.amplitude },
                      { "half_width", line.half_width },
                      { "phase", line.phase },
                      { "refusal", line.refusal } });
  }
  std::cout << Json{
    { "train", { report.train.from, report.train.to } },
    { "judge", { report.judge.from, report.judge.to } },
    { "values", values },
    { "lines", lines },
    { "ripple_resonance", found.parameters.telemetry.ripple_resonance },
    { "ripple_damping", found.parameters.telemetry.ripple_damping },
    { "ripple_lag", found.parameters.telemetry.ripple_lag },
    { "judged", errorsJson(found.judged) },
    { "left_out", errorsJson(report.left_out) }
  }.dump(2) << '\n';
}

void printText(const Report& report)
{
  const Identification& found = report.found;
  std::vector<NamedValue> values;
  const auto tell =
      [&](const std::string& name, double value, double half_width, const std::string& unit, const std::string& refusal)
  {
    if (refusal.empty())
    {
      values.push_back({ name, shortNumber(value) + " +- " + shortNumber(half_width), unit });
    }
    else
    {
      values.push_back({ name, "not identifiable from this motion: " + refusal, "" });
    }
  };
  for (const IdentifiedValue& value : found.values)
  {
    tell(value.name, value.value, value.half_width, value.unit, value.refusal);
  }
  for (const RippleLine& line : found.lines)
  {
    tell("ripple, " + shortNumber(line.order) + " a turn", line.amplitude, line.half_width, "N.m", line.refusal);
  }
  const auto span = [&](const std::string& name, const Span& part) {
    values.push_back({ name, shortNumber(part.from) + " to " + shortNumber(part.to), "s" });
  };
  span("identified on", report.train);
  span("judged on", report.judge);
  const auto error = [&](const std::string& name, const CurrentError& error)
  {
    values.push_back({ name,
                       shortNumber(error.all) + " (moving " + shortNumber(error.moving) + ", resting " +
                           shortNumber(error.resting) + ")",
                       "A" });
  };
  const auto errors = [&](const JudgedErrors& judged)
  {
    error("as configured", judged.configured);
    error("identified, without ripple", judged.without_ripple);
    error("identified", judged.identified);
    error("gain, Coulomb and viscous fitted alike", judged.gain_coulomb_viscous);
  };
  values.push_back({ "the current itself, rms", shortNumber(found.judged.identified.signal), "A" });
  values.push_back({ "error of the current on the judged part, rms", "", "" });
  errors(found.judged);
  if (report.left_out.identified.rows > 0)
  {
    values.push_back({ "on pieces of the part to identify on, each left out in turn", "", "" });
    errors(report.left_out);
  }
  printValues(values);
}

int identifyJoint(const IdentifyOptions& options)
{
  const Parameters parameters = loadParameters(options);
  if (!options.out.empty())
  {
    requireWritable(options.out, options.force, options.recording);
  }
  std::vector<MotionSample> samples;
  const bool load_recorded = recordsLoad(motionSource(options));
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
  Report report;
  report.train = span(options.train, 0.0, third);
  report.judge = span(options.judge, third, count.duration + PAST_THE_END);
  const JudgedPart judge{ part(samples, { -HUGE_VAL, report.judge.to }), report.judge.from };
  report.found = identify(parameters, part(samples, report.train), judge, load_recorded);
  report.left_out = leaveOneOut(parameters, samples, report.train, options.folds, load_recorded);
  if (!options.out.empty())
  {
    writeOverlay(options, report.found);
  }
  options.json ? printJson(report) : printText(report);
  return EXIT_DONE;
}
}  // namespace

void addIdentifyCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<IdentifyOptions>();
  auto* command = app.add_subcommand(
      "identify", "gain, friction, inertia and ripple of a joint from its recorded motion and current, as an overlay");
  addMotionOptions(*command, *options);
  command->add_option("--out", options->out, "the overlay")->type_name("FILE.yaml");
  command->add_option("--train", options->train, "from,to: what to identify on; default: the first third [s]")
      ->delimiter(',')
      ->expected(2)
      ->check(FINITE);
  command->add_option("--judge", options->judge, "from,to: what to judge on; default: the rest [s]")
      ->delimiter(',')
      ->expected(2)
      ->check(FINITE);
  command
      ->add_option("--folds", options->folds,
                   "cuts the part to identify on into so many pieces and tells how each is predicted by the others")
      ->check(CLI::Range(2, 100));
  command->callback([options, &exit_code] { exit_code = identifyJoint(*options); });
}
}  // namespace hjt
