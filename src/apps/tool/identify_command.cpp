// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "motion_options.hpp"
#include "output_file.hpp"
#include "text_table.hpp"
#include "validators.hpp"

#include "harmonic_joint_twin/params/number_text.hpp"
#include "harmonic_joint_twin/params/parameter_error.hpp"
#include "harmonic_joint_twin/twin/identification.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

struct IdentifyOptions : MotionOptions
{
  std::string out;
  std::vector<double> train;
  std::vector<double> judge;
};

std::vector<MotionSample> part(const std::vector<MotionSample>& all, double from, double to)
{
  std::vector<MotionSample> samples;
  for (const MotionSample& sample : all)
  {
    if (sample.time >= from && sample.time < to)
    {
      samples.push_back(sample);
    }
  }
  return samples;
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
  const auto add = [&](const std::string& key, double value, const std::string& comment)
  {
    const std::size_t dot = key.find('.');
    sections[key.substr(0, dot)].push_back({ comment, key.substr(dot + 1) + ": " + numberText(value) });
  };
  for (const IdentifiedValue& value : found.values)
  {
    if (!value.refusal.empty() || value.key.empty())
    {
      continue;
    }
    add(value.key, value.value,
        value.name + " [" + value.unit + "]; 95 %: +-" + shortNumber(value.half_width) + ". Identified.");
    if (value.key == "mesh.friction_kinetic")
    {
      add("mesh.friction_static", found.parameters.mesh.friction_static, "In proportion.");
    }
  }
  std::FILE* file = std::fopen(options.out.c_str(), "w");
  if (file == nullptr)
  {
    throw InputError(options.out + " cannot be written");
  }
  std::fprintf(file, "# Overlay: what `joint_twin identify` found for joint %s in\n# %s\n", options.joint.c_str(),
               options.recording.c_str());
  for (const auto& [section, entries] : sections)
  {
    std::fprintf(file, "\n%s:\n", section.c_str());
    for (const Entry& entry : entries)
    {
      std::fprintf(file, "  # %s\n  %s\n", entry.name.c_str(), entry.text.c_str());
    }
  }
  if (std::fclose(file) != 0)
  {
    throw InputError(options.out + " could not be written in full");
  }
}

Json errorJson(const CurrentError& error)
{
  return { { "rows", error.rows },
           { "all", error.all },
           { "moving", error.moving },
           { "resting", error.resting },
           { "signal", error.signal } };
}

void printJson(const Identification& found)
{
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
    lines.push_back({ { "order", line.order },
                      { "amplitude", line.amplitude },
                      { "half_width", line.half_width },
                      { "phase", line.phase },
                      { "refusal", line.refusal } });
  }
  std::cout << Json{
    { "values", values },
    { "lines", lines },
    { "loop_frequency", found.loop_frequency },
    { "loop_damping", found.loop_damping },
    { "lag", found.lag },
    { "correlation_rows", found.correlation_rows },
    { "judged",
      { { "configured", errorJson(found.before) },
        { "identified", errorJson(found.after) },
        { "identified_with_lines", errorJson(found.with_lines) },
        { "gain_coulomb_viscous", errorJson(found.gain_coulomb_viscous) } } }
  }.dump(2) << '\n';
}

void printText(const Identification& found)
{
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
  const auto judged = [&](const std::string& name, const CurrentError& error)
  {
    values.push_back({ name,
                       shortNumber(error.all) + " (moving " + shortNumber(error.moving) + ", resting " +
                           shortNumber(error.resting) + ")",
                       "A" });
  };
  judged("error of the current, as configured, rms", found.before);
  judged("identified", found.after);
  judged("identified, with ripple", found.with_lines);
  judged("gain, Coulomb and viscous fitted alike", found.gain_coulomb_viscous);
  values.push_back({ "the current itself, rms", shortNumber(found.after.signal), "A" });
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
  const MotionCount count =
      visitMotion(options, MotionDriven(parameters), [&](const MotionSample& sample) { samples.push_back(sample); });
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  const auto range = [&](const std::vector<double>& given, double from, double to)
  { return given.empty() ? part(samples, from, to) : part(samples, given[0], given[1]); };
  const double end = count.duration + 1.0;
  const double third = count.duration / 3.0;
  const Identification found =
      identify(parameters, range(options.train, 0.0, third), range(options.judge, third, end), load_recorded);
  if (!options.out.empty())
  {
    writeOverlay(options, found);
  }
  options.json ? printJson(found) : printText(found);
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
  command->callback([options, &exit_code] { exit_code = identifyJoint(*options); });
}
}  // namespace hjt
